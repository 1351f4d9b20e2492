// Where particles touch bodies, or may within the step.
#include "engine/dynamics/world.h"

namespace plumb::inline PLUMB_PRECISION {

void World::find_particle_contacts(TaskPool *) const {
    scratch_.particle_contacts.clear();
}

} // namespace plumb::inline PLUMB_PRECISION
