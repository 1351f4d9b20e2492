// The only list of methods. Command line, panels, charts and tests read it.
#include "engine/dynamics/method.h"

#include <algorithm>
#include <vector>

// One line per method: the function of that name, in its own file, returns the method's row.
#define PLUMB_METHODS(METHOD)                                                                      \
    METHOD(soft_step)                                                                              \
    METHOD(tgs_soft)                                                                               \
    METHOD(sequential_impulses)                                                                    \
    METHOD(nncg)                                                                                   \
    METHOD(xpbd)                                                                                   \
    METHOD(avbd)                                                                                   \
    METHOD(naive_impulses)                                                                         \
    METHOD(explicit_euler)                                                                         \
    METHOD(semi_implicit_euler)                                                                    \
    METHOD(stormer_verlet)                                                                         \
    METHOD(velocity_verlet)                                                                        \
    METHOD(rk4)                                                                                    \
    METHOD(backward_euler)                                                                         \
    METHOD(naive_spin)                                                                             \
    METHOD(split_spin)

namespace plumb::inline PLUMB_PRECISION {

#define PLUMB_DECLARE_METHOD(name) Method name();
PLUMB_METHODS(PLUMB_DECLARE_METHOD)
#undef PLUMB_DECLARE_METHOD

std::span<const Method> methods() {
#define PLUMB_METHOD_ROW(name) name(),
    static const std::vector<Method> rows{PLUMB_METHODS(PLUMB_METHOD_ROW)};
#undef PLUMB_METHOD_ROW
    return rows;
}

const Method *find_method(std::string_view name) {
    const std::span<const Method> rows = methods();
    const auto found = std::ranges::find(rows, name, [](const Method &m) { return m.info.name; });
    return found == rows.end() ? nullptr : &*found;
}

} // namespace plumb::inline PLUMB_PRECISION
