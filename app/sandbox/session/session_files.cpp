// A session's file handling: opening, reloading and writing scenes and recordings.
#include "app/sandbox/session/session.h"

#include "engine/scene/scene_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

namespace plumb {

namespace {

std::string text_of(const std::filesystem::path &path) {
    std::ifstream file(path, std::ios::binary);
    if (!std::filesystem::is_regular_file(path) || !file)
        throw std::runtime_error(path.string() + " cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_whole(const std::filesystem::path &path, const std::string &text) {
    OutputFile file(path);
    file.stream() << text;
    file.finish();
}

} // namespace

bool Session::open(const std::filesystem::path &path) {
    SceneFileResult file;
    std::optional<SceneText> text;
    try {
        if (std::filesystem::is_regular_file(path)) // a pipe can only be read once
            text = SceneText{path, text_of(path)};
        file = load_scene(path);
    } catch (const std::bad_alloc &failure) {
        messages_.error(path.filename().string() + ": " + reason(failure));
        return false;
    } catch (const std::runtime_error &failure) {
        messages_.error(failure.what());
        return false;
    }
    say(path, file.messages);
    return file.ok() && open(file.scene, path, std::move(text));
}

void Session::say(const std::filesystem::path &path, const std::vector<SceneMessage> &all) {
    for (const SceneMessage &message : all)
        messages_.say(message.severity == SceneMessage::Severity::error
                          ? Message::Severity::error
                          : Message::Severity::warning,
                      format_message(path.filename().string(), message));
}

bool Session::open_recording(const std::filesystem::path &path) {
    RecordingResult file;
    try {
        file = load_recording(path);
    } catch (const std::bad_alloc &failure) {
        messages_.error(path.filename().string() + ": " + reason(failure));
        return false;
    }
    say(path, file.messages);
    return file.ok() && play(file.recording, path);
}

bool Session::reload() {
    if (path_.empty()) {
        messages_.note("This scene has no file to reload.");
        return false;
    }
    const std::filesystem::path path = path_; // copy: open() assigns path_
    if (!(recording_ ? open_recording(path) : open(path)))
        return false;
    messages_.note("Reloaded " + path.filename().string() + ".");
    return true;
}

// Copies the files the scene refers to: it looks for them in its own folder.
void Session::save_mesh_files(const std::filesystem::path &folder) const {
    std::set<std::string> names;
    const auto add = [&](const auto &of) {
        if (const ShapeFile *file = shape_file(of.shape))
            names.insert(file->name);
    };
    for (const ProbeDesc &probe : probes_)
        std::ranges::for_each(probe.shapes, add);
    for (std::size_t body = 0; body < simulation_->body_count(); ++body)
        if (simulation_->body_info(body).alive)
            std::ranges::for_each(simulation_->body_info(body).colliders, add);
    for (const ClothDesc &cloth : scene_.cloths)
        if (cloth.mesh)
            names.insert(cloth.file.name);
    for (const std::string &name : names) {
        const std::filesystem::path from = path_.parent_path() / name;
        const std::filesystem::path to = folder / name;
        if (!std::filesystem::exists(to))
            write_whole(to, text_of(from));
        else if (text_of(from) != text_of(to))
            throw std::runtime_error(to.string() + " already exists and is a different mesh");
    }
}

void Session::write_recording(OutputFile &file) const {
    if (!recorder_)
        throw std::runtime_error(simulation_ ? scene_.name + " has only probes: there is nothing "
                                                             "to record"
                                             : "no scene is running: there is nothing to record");
    save_mesh_files(file.path().parent_path());
    file.stream() << plumb::write_recording(recorder_->recording(*simulation_));
    file.finish();
}

SceneText Session::scene_text() const {
    return text_ ? *text_ : SceneText{path_, write_scene(scene_)};
}

bool Session::save_plots(const std::filesystem::path &path) {
    try {
        if (path.has_parent_path())
            create_folder(path.parent_path());
        OutputFile file(path);
        plots_.write_csv(file.stream());
        file.finish();
        messages_.note("Saved " + path.string());
        return true;
    } catch (const std::exception &failure) {
        messages_.error("Cannot save the plots: " + reason(failure));
        return false;
    }
}

bool Session::save_scene(const std::filesystem::path &path) {
    if (!simulation_)
        return false;
    try {
        SceneDesc present = simulation_->describe();
        present.probes = probes_;
        const std::string text = write_scene(present);
        if (text.size() > max_scene_file_bytes)
            throw std::runtime_error("it would exceed the size limit of a scene file, " +
                                     std::to_string(max_scene_file_bytes >> 20U) + " MiB");
        if (path.has_parent_path())
            create_folder(path.parent_path());
        save_mesh_files(path.parent_path());
        write_whole(path, text);
        messages_.note("Saved " + path.string());
        return true;
    } catch (const std::exception &failure) {
        messages_.error("Cannot save the scene: " + reason(failure));
        return false;
    }
}

} // namespace plumb
