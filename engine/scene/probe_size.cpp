#include "engine/scene/probe_size.h"

#include "engine/scene/triangle_count.h"

#include <variant>

namespace plumb {

namespace {

struct SizeCounter {
    ProbeSize &size;

    void operator()(const FlatCompoundDesc &compound) const {
        size.shapes += compound.parts.size();
    }
    template <typename Plain> void operator()(const Plain &shape) const {
        size.triangles += triangle_count(shape);
    }
};

} // namespace

ProbeSize size_of(const ProbeDesc &probe) {
    ProbeSize size;
    size.shapes = probe.shapes.size();
    for (const ProbeShapeDesc &shape : probe.shapes)
        std::visit(SizeCounter{size}, shape.shape);
    if (probe.scatter)
        size.scattered = static_cast<std::size_t>(probe.scatter->count);
    const std::size_t shapes = probe.shapes.size();
    size.questions = probe.question == ProbeQuestion::overlap ? shapes * (shapes - 1) / 2
                                                              : shapes * probe.points.size();
    return size;
}

} // namespace plumb
