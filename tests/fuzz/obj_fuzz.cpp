// libFuzzer target: whatever the bytes, read_obj gives a sound mesh or one message.
#include "engine/scene/obj_file.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    std::istringstream in(std::string(reinterpret_cast<const char *>(data), size));
    const plumb::ObjResult result = plumb::read_obj(in, "fuzz.obj");
    if (!result.ok()) {
        // One line, and no partial mesh with it.
        if (result.error.find('\n') != std::string::npos ||
            !result.error.starts_with("fuzz.obj:") || !result.mesh.vertices.empty() ||
            !result.mesh.triangles.empty())
            std::abort();
        return 0;
    }
    if (result.mesh.triangles.empty())
        std::abort();
    for (const glm::dvec3 &vertex : result.mesh.vertices)
        for (int i = 0; i < 3; ++i)
            if (!(std::abs(vertex[i]) <= plumb::max_obj_coordinate))
                std::abort();
    for (const auto &triangle : result.mesh.triangles)
        for (const std::uint32_t corner : triangle)
            if (corner >= result.mesh.vertices.size())
                std::abort();
    return 0;
}
