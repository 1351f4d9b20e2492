#include "app/list.h"

#include "app/sandbox/keys.h"
#include "engine/dynamics/method_info.h"
#include "engine/scene/file/number.h"
#include "engine/scene/given_settings.h"

#include <cstdio>
#include <iomanip>
#include <string>
#include <string_view>
#include <utility>

namespace plumb {

namespace {

std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += '\\';
        if (static_cast<unsigned char>(c) < 0x20) {
            char escaped[8];
            std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
            out += escaped;
        } else {
            out += c;
        }
    }
    return out + '"';
}

// A JSON array of objects, one per line. Values must already be JSON.
class JsonArray {
  public:
    using Members = std::initializer_list<std::pair<std::string_view, std::string>>;

    explicit JsonArray(std::ostream &out) : out_(out) { out_ << "["; }
    void add(const Members &members) {
        out_ << (first_ ? "\n  {" : ",\n  {");
        first_ = false;
        const char *separator = "";
        for (const auto &[name, value] : members) {
            out_ << separator << json_string(name) << ": " << value;
            separator = ", ";
        }
        out_ << "}";
    }
    void end() { out_ << "\n]\n"; }

  private:
    std::ostream &out_;
    bool first_ = true;
};

std::string json_bool(bool value) {
    return value ? "true" : "false";
}

void scenes_as_json(const std::vector<SceneEntry> &catalogue, std::ostream &out) {
    JsonArray array(out);
    for (const SceneEntry &s : catalogue)
        array.add({{"subject", json_string(s.subject)},
                   {"name", json_string(s.name)},
                   {"title", json_string(s.title)},
                   {"path", json_string(s.path.string())}});
    array.end();
}

void methods_as_json(std::ostream &out) {
    JsonArray array(out);
    for (const MethodInfo &m : method_infos())
        array.add({{"name", json_string(m.name)},
                   {"title", json_string(m.title)},
                   {"contacts", json_bool(m.contacts)},
                   {"joints", json_bool(m.joints)},
                   {"springs", json_bool(m.springs)},
                   {"source", json_string(m.source)}});
    array.end();
}

void settings_as_json(std::ostream &out) {
    JsonArray array(out);
    for (const SettingRow &row : setting_rows)
        array.add({{"name", json_string(row.name)},
                   {"unit", json_string(row.unit)},
                   {"min", shortest(row.min)},
                   {"max", shortest(row.max)},
                   {"whole", json_bool(is_whole(row))},
                   {"vector", json_bool(is_vector(row))},
                   {"about", json_string(row.reason)}});
    array.end();
}

void keys_as_json(std::ostream &out) {
    JsonArray array(out);
    for (const ActionInfo &action : actions()) {
        std::string chords;
        for (const Chord &chord : action.chords)
            chords += (chords.empty() ? "" : ", ") + json_string(name(chord));
        array.add({{"keys", "[" + chords + "]"},
                   {"title", json_string(action.title)},
                   {"about", json_string(action.about)}});
    }
    for (const MouseInfo &mouse : mouse_gestures())
        array.add({{"gesture", json_string(mouse.gesture)},
                   {"title", json_string(mouse.title)},
                   {"about", json_string(mouse.about)}});
    array.end();
}

void scenes_as_text(const std::vector<SceneEntry> &catalogue, std::ostream &out) {
    std::string subject;
    for (const SceneEntry &s : catalogue) {
        if (s.subject != subject)
            out << (subject.empty() ? "" : "\n") << s.subject << '\n';
        subject = s.subject;
        out << "  " << std::left << std::setw(20) << s.name << s.title << '\n';
    }
}

// What the method can run: "contacts, joints, springs".
std::string what_runs(const MethodInfo &method) {
    std::string what = method.contacts ? "contacts" : "free bodies";
    if (method.joints)
        what += ", joints";
    if (method.springs)
        what += ", springs";
    return what;
}

void methods_as_text(std::ostream &out) {
    for (const MethodInfo &m : method_infos())
        out << std::left << std::setw(22) << m.name << std::setw(22) << m.title << std::setw(27)
            << what_runs(m) << m.source << '\n';
}

} // namespace

void list(Listed what, bool json, const std::vector<SceneEntry> &catalogue, std::ostream &out) {
    switch (what) {
    case Listed::scenes:
        return json ? scenes_as_json(catalogue, out) : scenes_as_text(catalogue, out);
    case Listed::methods:
        return json ? methods_as_json(out) : methods_as_text(out);
    case Listed::keys:
        if (json)
            return keys_as_json(out);
        out << keys_as_markdown();
        return;
    case Listed::settings:
        if (json)
            return settings_as_json(out);
        out << settings_as_markdown();
    }
}

} // namespace plumb
