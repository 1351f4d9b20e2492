#include "tests/golden/golden_record.h"

#include "app/render/png.h"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>

namespace plumb::golden {

namespace fs = std::filesystem;

fs::path picture_dir() {
    return fs::path(PLUMB_SOURCE_DIR) / "tests" / "golden" / "pictures";
}

fs::path picture_path(const Case &golden) {
    return picture_dir() / (golden.name + ".png");
}

fs::path sidecar_path(const Case &golden) {
    return picture_dir() / (golden.name + ".toml");
}

std::string hash_text(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::optional<Record> read_record(const Case &golden) {
    if (!fs::exists(picture_path(golden)) && !fs::exists(sidecar_path(golden)))
        return {};
    // The subset of TOML that write_record uses: key = "value", one per line.
    std::map<std::string, std::string> values;
    std::ifstream file(sidecar_path(golden));
    for (std::string line; std::getline(file, line);) {
        const std::size_t begin = line.find(" = \"");
        const std::size_t end = line.rfind('"');
        if (begin != std::string::npos && end >= begin + 4)
            values[line.substr(0, begin)] = line.substr(begin + 4, end - begin - 4);
    }
    for (const char *key : {"state_hash", "renderer", "version", "cpu"})
        if (!values.contains(key))
            throw std::runtime_error(sidecar_path(golden).string() + ": has no " + key);
    Record record;
    const std::string &hash = values["state_hash"];
    const char *hash_end = hash.data() + hash.size();
    const auto parsed = std::from_chars(hash.data(), hash_end, record.state_hash, 16);
    if (hash.size() != 16 || parsed.ec != std::errc{} || parsed.ptr != hash_end)
        throw std::runtime_error(sidecar_path(golden).string() + ": '" + hash +
                                 "' is not 16 hexadecimal digits");
    record.rasterizer = {values["renderer"], values["version"], values["cpu"]};
    record.picture = read_png(picture_path(golden));
    return record;
}

void write_record(const Case &golden, const Rendering &rendering) {
    write_png(picture_path(golden), rendering.picture);
    std::ofstream file(sidecar_path(golden), std::ios::trunc);
    file << "scene = \"" << golden.scene << "\"\n"
         << "step = " << golden.step << '\n'
         << "state_hash = \"" << hash_text(rendering.state_hash) << "\"\n"
         << "renderer = \"" << rendering.rasterizer.renderer << "\"\n"
         << "version = \"" << rendering.rasterizer.version << "\"\n"
         << "cpu = \"" << rendering.rasterizer.cpu << "\"\n";
    file.close();
    if (!file)
        throw std::runtime_error(sidecar_path(golden).string() + ": could not be written");
}

} // namespace plumb::golden
