// A golden picture on disk: a PNG, and a sidecar that says what it shows and what drew it.
#pragma once

#include "tests/golden/golden_case.h"

#include <filesystem>
#include <optional>
#include <string>

namespace plumb::golden {

struct Record {
    std::uint64_t state_hash = 0;
    Rasterizer rasterizer;
    Image picture;
};

// tests/golden/pictures
std::filesystem::path picture_dir();
std::filesystem::path picture_path(const Case &golden);
std::filesystem::path sidecar_path(const Case &golden);

// nullopt if there is no picture yet. Throws std::runtime_error if a file is there but broken.
std::optional<Record> read_record(const Case &golden);
void write_record(const Case &golden, const Rendering &rendering);

std::string hash_text(std::uint64_t hash); // 16 hexadecimal digits

} // namespace plumb::golden
