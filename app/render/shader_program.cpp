#include "app/render/shader_program.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <glad/gl.h>

namespace plumb {

namespace {

// A shader's source with its includes expanded, and where each line came from. (GLSL's #line could
// number the files, but Mesa forgets the number in most of its messages.)
struct Source {
    struct Line {
        std::string file;
        std::size_t number;
    };
    std::string text;
    std::vector<Line> lines;
};

void append_file(const std::filesystem::path &dir, const std::string &name,
                 const std::string &definition, int depth, Source &source) {
    const std::string path = (dir / name).string();
    if (depth > 8)
        throw std::runtime_error(path + ": circular #include");
    std::ifstream file(path);
    if (!file)
        throw std::runtime_error(path + ": cannot read the shader");
    const std::string directive = "#include \"";
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        if (!line.starts_with(directive)) {
            source.text += line + "\n";
            source.lines.push_back({path, number});
            if (depth == 0 && number == 1 && !definition.empty()) {
                source.text += definition + "\n";
                source.lines.push_back({path, number});
            }
            continue;
        }
        const std::size_t end = line.find('"', directive.size());
        if (end == std::string::npos)
            throw std::runtime_error(path + ":" + std::to_string(number) +
                                     ": #include without a closing quote");
        append_file(dir, line.substr(directive.size(), end - directive.size()), definition,
                    depth + 1, source);
    }
}

// Driver messages begin with a file number, always 0 here, and the line: "0:12(5): error: ..." in
// Mesa, "0(12) : error ..." elsewhere.
std::string name_lines(const std::string &log, const std::vector<Source::Line> &lines) {
    std::istringstream in(log);
    std::string result;
    std::string text;
    while (std::getline(in, text)) {
        std::size_t end = 0;
        std::size_t number = 0;
        if (text.starts_with("0:") || text.starts_with("0("))
            for (end = 2; end < std::min<std::size_t>(text.size(), 8) &&
                          std::isdigit(static_cast<unsigned char>(text[end])) != 0;
                 ++end)
                number = 10 * number + static_cast<std::size_t>(text[end] - '0');
        if (number >= 1 && number <= lines.size())
            text = lines[number - 1].file + ":" + std::to_string(lines[number - 1].number) +
                   text.substr(end);
        result += "\n" + text;
    }
    return result;
}

GLuint compile(GLenum stage, const std::filesystem::path &dir, const std::string &name,
               const std::string &definition) {
    Source source;
    append_file(dir, name, definition, 0, source);
    const GLuint shader = glCreateShader(stage);
    const char *text = source.text.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled != GL_TRUE) {
        GLint length = 0;
        glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length) + 1, '\0');
        glGetShaderInfoLog(shader, length, nullptr, log.data());
        log.resize(log.find('\0'));
        glDeleteShader(shader);
        throw std::runtime_error((dir / name).string() + ": the shader does not compile" +
                                 name_lines(log, source.lines));
    }
    return shader;
}

} // namespace

ShaderProgram::ShaderProgram(const std::filesystem::path &dir, const std::string &vertex,
                             const std::string &fragment, const std::string &definition) {
    const GLuint vertex_shader = compile(GL_VERTEX_SHADER, dir, vertex, definition);
    GLuint fragment_shader = 0;
    try {
        fragment_shader = compile(GL_FRAGMENT_SHADER, dir, fragment, definition);
    } catch (...) {
        glDeleteShader(vertex_shader);
        throw;
    }
    program_ = glCreateProgram();
    glAttachShader(program_, vertex_shader);
    glAttachShader(program_, fragment_shader);
    glLinkProgram(program_);
    glDeleteShader(vertex_shader);
    glDeleteShader(fragment_shader);
    GLint linked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        GLint length = 0;
        glGetProgramiv(program_, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length) + 1, '\0');
        glGetProgramInfoLog(program_, length, nullptr, log.data());
        log.resize(log.find('\0'));
        glDeleteProgram(program_);
        throw std::runtime_error((dir / vertex).string() + " and " + fragment +
                                 ": the shaders do not link\n" + log);
    }
}

ShaderProgram::~ShaderProgram() {
    if (program_ != 0)
        glDeleteProgram(program_);
}

ShaderProgram::ShaderProgram(ShaderProgram &&other) noexcept
    : program_(std::exchange(other.program_, 0)) {}

ShaderProgram &ShaderProgram::operator=(ShaderProgram &&other) noexcept {
    std::swap(program_, other.program_);
    return *this;
}

void ShaderProgram::use() const {
    glUseProgram(program_);
}

int ShaderProgram::uniform(const char *name) const {
    return glGetUniformLocation(program_, name);
}

void ShaderProgram::bind_block(const char *name, unsigned binding) const {
    const GLuint index = glGetUniformBlockIndex(program_, name);
    if (index != GL_INVALID_INDEX)
        glUniformBlockBinding(program_, index, binding);
}

void ShaderProgram::bind_sampler(const char *name, int unit) const {
    use();
    glUniform1i(uniform(name), unit);
}

} // namespace plumb
