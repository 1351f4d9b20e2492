// A shape kind's keys, and its fields in words, without an actual shape. Not for users of the
// engine.
#pragma once

#include "engine/scene/file/number.h"
#include "engine/scene/shape_kinds.h"

#include <string>
#include <string_view>
#include <vector>

namespace plumb::scene_file {

// A visitor that lists a kind's fields.
class FieldList {
  public:
    void length(std::string_view key, double &, std::string_view = {}) { add(key); }
    void size(std::string_view key, glm::dvec3 &) { add(key); }
    void turn(std::string_view key, double &) {
        add(std::string(key) + "_deg");
        keys_.emplace_back(key);
    }
    template <std::size_t count>
    void corners(std::string_view key, std::array<glm::dvec3, count> &) {
        add(key);
    }
    template <typename Points> void cloud(std::string_view key, Points &) { add(key); }
    template <typename Ways> void run(const Ways &way) {
        join_ = way_ == 0 ? join_ : "; or ";
        ++way_;
        way.fields();
    }
    template <typename... Ways> void either(std::string_view, const Ways &...ways) {
        way_ = 0;
        (run(ways), ...);
        join_ = "; and ";
    }
    void file(ShapeFile &file) {
        add("file");
        add("scale", shortest(file.scale));
    }
    template <typename Word, std::size_t count>
    void word(std::string_view key, Word &word, const std::array<std::string_view, count> &names,
              bool is_optional) {
        std::string all;
        for (const std::string_view name : names)
            all += (all.empty() ? "`\"" : ", `\"") + std::string(name) + "\"`";
        if (is_optional)
            all = "`\"" + std::string(names[static_cast<std::size_t>(word)]) + "\"`; " + all;
        add(key, all);
    }
    void whole(std::string_view key, int &value, int min, int max) {
        add(key, std::to_string(value) + "; " + std::to_string(min) + " to " + std::to_string(max));
    }
    template <typename Data>
    void surface(std::string_view vertices, std::string_view triangles, Data &) {
        add(vertices);
        add(triangles);
    }
    void heights(std::string_view key, HeightFieldDesc &) { add(key); }
    void parts(std::string_view key, std::vector<FlatPartDesc> &) { add(key); }

    const std::vector<std::string> &keys() const { return keys_; }
    const std::string &text() const { return text_; }

  private:
    void add(std::string_view key, const std::string &values = {}) {
        keys_.emplace_back(key);
        text_ += (text_.empty() ? "" : join_) + "`" + std::string(key) + "`";
        join_ = ", ";
        if (!values.empty())
            text_ += " (" + values + ")";
    }

    std::vector<std::string> keys_;
    std::string text_;
    std::string join_;
    int way_ = 0;
};

template <typename Shape> const FieldList &fields_of() {
    static const FieldList list = [] {
        FieldList made;
        Shape shape;
        Kind<Shape>::fields(shape, made);
        return made;
    }();
    return list;
}

// The shape section of scenes/README.md.
std::string shape_reference();

} // namespace plumb::scene_file
