// A GLSL program made from files.
#pragma once

#include <filesystem>
#include <string>

namespace plumb {

// Draws with the files NAME.vert and NAME.frag of a folder, or with two names. A line
//   #include "file"
// in them is replaced by that file of the same folder.
class ShaderProgram {
  public:
    // `definition`, if any, is a line put after the first of each file ("#define HARD"). Throws
    // std::runtime_error; a compiler's message names file and line.
    ShaderProgram(const std::filesystem::path &dir, const std::string &vertex,
                  const std::string &fragment, const std::string &definition = {});
    ~ShaderProgram();
    ShaderProgram(ShaderProgram &&other) noexcept;
    ShaderProgram &operator=(ShaderProgram &&other) noexcept;

    void use() const;
    // The location of a uniform; -1, which GL ignores, if the compiler left it out.
    [[nodiscard]] int uniform(const char *name) const;
    // Connects a uniform block and samplers to their binding points, once.
    void bind_block(const char *name, unsigned binding) const;
    void bind_sampler(const char *name, int unit) const;

  private:
    unsigned program_ = 0;
};

} // namespace plumb
