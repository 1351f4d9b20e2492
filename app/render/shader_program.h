// A GLSL program built from files.
#pragma once

#include <filesystem>
#include <string>

namespace plumb {

// Built from a vertex and a fragment shader file of a folder. A line
//   #include "file"
// in them is replaced by that file from the same folder.
class ShaderProgram {
  public:
    // `definition`, if any, is a line inserted after the first of each file ("#define HARD").
    // Throws std::runtime_error; a compiler's message names file and line.
    ShaderProgram(const std::filesystem::path &dir, const std::string &vertex,
                  const std::string &fragment, const std::string &definition = {});
    ~ShaderProgram();
    ShaderProgram(ShaderProgram &&other) noexcept;
    ShaderProgram &operator=(ShaderProgram &&other) noexcept;

    void use() const;
    // The location of a uniform; -1, which GL ignores, if the compiler removed it.
    [[nodiscard]] int uniform(const char *name) const;
    // Binds a uniform block or sampler to its binding point, once.
    void bind_block(const char *name, unsigned binding) const;
    void bind_sampler(const char *name, int unit) const;

  private:
    unsigned program_ = 0;
};

} // namespace plumb
