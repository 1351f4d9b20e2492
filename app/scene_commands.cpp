// Commands that open, render, list and compare scenes.
#include "app/commands.h"

#include "app/hash.h"
#include "app/lab/interrupt.h"
#include "app/list.h"
#include "app/render/compare_images.h"
#include "app/render/png.h"
#include "app/replay.h"
#include "app/sandbox/run_sandbox.h"
#include "app/snapshot.h"
#include "engine/scene/recording.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace plumb {

namespace {

constexpr const char *default_scene = "wrecking_ball";
// The default scene makes its best picture here: the ball is in the wall.
constexpr std::uint64_t default_scene_step = 125;

struct RunArguments {
    std::optional<int> frames, samples;
    std::optional<float> ui_scale;
    std::filesystem::path screenshot, record;
};

int run(const CommonOptions &common, const RunArguments &arguments) {
    TaskPool tasks(common.threads);
    SandboxOptions options;
    options.scenes = common.catalogue;
    options.initial_scene = common.scenes.empty()
                                ? resolve_scene(default_scene, common.catalogue)
                                : resolve_scene(common.scenes.front(), common.catalogue);
    options.gl = gl_choice_from_name(common.gl);
    if (!common.size.empty())
        options.size = parse_size(common.size);
    options.shader_dir = common.shader_dir();
    options.out_dir = common.out;
    options.run = common.run();
    options.tasks = &tasks;
    options.max_frames = arguments.frames;
    options.screenshot = arguments.screenshot;
    options.record = arguments.record;
    options.samples = arguments.samples;
    options.ui_scale = arguments.ui_scale;
    const SandboxResult result = run_sandbox(options);
    if (result.why_no_window.empty())
        return result.exit_code;

    if (!arguments.record.empty())
        throw ContextError("no window: " + result.why_no_window +
                           "; with --frames N the run is recorded without one");
    std::cerr << "plumb: no window: " << result.why_no_window
              << "\nplumb: drawing the scene off screen instead\n";
    SnapshotCommand snapshot;
    snapshot.scenes = {options.initial_scene};
    snapshot.run = options.run;
    snapshot.at = {common.scenes.empty() ? default_scene_step : 0};
    snapshot.size = common.size.empty() ? glm::ivec2{1280, 720} : options.size;
    snapshot.out_dir = common.out;
    snapshot.shader_dir = common.shader_dir();
    snapshot.numbered = false;
    snapshot.gl = GlChoice::osmesa;
    snapshot.samples = arguments.samples.value_or(snapshot.samples);
    snapshot.tasks = &tasks;
    return code_of(make_snapshots(snapshot, std::cout, std::cerr));
}

// In a window if possible, else without. Errors in the file are reported by the windowless path.
int replay_or_play(const CommonOptions &common, ReplayCommand command, bool no_window) {
    TaskPool tasks(common.threads);
    command.tasks = &tasks;
    if (!no_window && load_recording(command.recording).ok()) {
        SandboxOptions options;
        options.scenes = common.catalogue;
        options.recording = command.recording;
        options.shader_dir = common.shader_dir();
        options.out_dir = common.out;
        options.tasks = &tasks;
        const SandboxResult result = run_sandbox(options);
        if (result.why_no_window.empty())
            return result.exit_code;
    }
    return code_of(replay(command, std::cout, std::cerr));
}

struct SnapshotArguments {
    std::string at;
    std::uint64_t every = 0, steps = 0;
    bool panels = false;
    int samples = 4;
    float ui_scale = 1;
};

int snapshot(const CommonOptions &common, const SnapshotArguments &arguments) {
    TaskPool tasks(common.threads);
    SnapshotCommand command;
    command.scenes = common.scene_paths();
    command.run = common.run();
    if (!arguments.at.empty())
        command.at = parse_steps(arguments.at);
    if (arguments.every > 0)
        for (std::uint64_t step = 0; step <= arguments.steps; step += arguments.every)
            command.at.push_back(step);
    if (command.at.empty())
        command.at.push_back(arguments.steps);
    std::ranges::sort(command.at);
    command.at.erase(std::unique(command.at.begin(), command.at.end()), command.at.end());
    if (!common.size.empty())
        command.size = parse_size(common.size);
    command.out_dir = common.out;
    command.shader_dir = common.shader_dir();
    command.panels = arguments.panels;
    command.catalogue = common.catalogue;
    command.samples = arguments.samples;
    command.ui_scale = arguments.ui_scale;
    command.gl = gl_choice_from_name(common.gl);
    command.tasks = &tasks;
    return code_of(make_snapshots(command, std::cout, std::cerr));
}

// The PNG decoder does not say why a file could not be opened.
Image read_picture(const std::filesystem::path &path) {
    if (!std::ifstream(path))
        throw std::runtime_error("cannot read " + path.string() + ": " +
                                 std::generic_category().message(errno));
    return read_png(path);
}

int compare(const std::filesystem::path &a_path, const std::filesystem::path &b_path, int tolerance,
            const std::filesystem::path &difference_path) {
    const Image a = read_picture(a_path);
    const Image b = read_picture(b_path);
    const ImageDifference difference = compare_images(a, b);
    if (!difference.same_size) {
        std::cout << "different sizes: " << a.width << "x" << a.height << " and " << b.width << "x"
                  << b.height << '\n';
        return code_of(ExitCode::outside_tolerance);
    }
    std::cout << "largest channel difference       " << difference.max_difference << " of 255\n"
              << "mean difference                  " << difference.mean_difference << " of 255\n"
              << "pixels more than 2 off           " << 100 * difference.fraction_beyond << " %\n"
              << "FLIP, mean                       " << difference.flip_mean << '\n'
              << "FLIP, 95th percentile            " << difference.flip_percentile << '\n';
    if (!difference_path.empty()) {
        write_png(difference_path, difference.picture);
        std::cout << difference_path.string() << '\n';
    }
    return code_of(difference.max_difference <= tolerance ? ExitCode::fine
                                                          : ExitCode::outside_tolerance);
}

struct ReplayArguments {
    ReplayCommand command;
    bool no_window = false;
};

struct ListArguments {
    bool json = false, keys = false, methods = false, settings = false;
};

struct CompareArguments {
    std::filesystem::path a, b, difference;
    int tolerance = 0;
};

} // namespace

std::function<int()> add_run(CommandLine &line) {
    const auto arguments = std::make_shared<RunArguments>();
    CLI::App *run_command = line.app.add_subcommand(
        "run", "Opens the sandbox (the default); without a display, draws the scene to a PNG");
    run_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->expected(0, 1);
    add_run_options(*run_command, line.common);
    add_gl(*run_command, line.common);
    add_out(*run_command, line.common, "out");
    run_command->add_option("--size", line.common.size, "Window size, WIDTHxHEIGHT (1280x800)");
    run_command
        ->add_option("--samples", arguments->samples,
                     "Multisampling samples; 1: none (4, or 1 without a GPU)")
        ->check(CLI::Range(1, 16));
    add_ui_scale(*run_command, arguments->ui_scale, "the monitor's");
    run_command->add_option("--frames", arguments->frames, "Quits after this many frames")
        ->check(positive());
    run_command->add_option("--screenshot", arguments->screenshot,
                            "PNG file to write the last frame to");
    run_command->add_option(
        "--record", arguments->record,
        "File to write the run to when it ends, with everything done to it, for "
        "`plumb replay`");
    run_command->callback([=, &line] { line.result = run(line.common, *arguments); });
    return [=, &line] { return run(line.common, *arguments); };
}

void add_replay(CommandLine &line) {
    const auto arguments = std::make_shared<ReplayArguments>();
    CLI::App *replay_command = line.app.add_subcommand(
        "replay",
        "Replays a recording in the sandbox, or without it if there is no display, and says "
        "whether and where it differs");
    replay_command
        ->add_option("FILE", arguments->command.recording,
                     "Recording from `plumb run --record FILE`")
        ->required();
    replay_command->add_flag(
        "--no-window", arguments->no_window,
        "Replays without the sandbox, at full speed, and prints the last hash");
    add_out(*replay_command, line.common, "out");
    add_threads(*replay_command, line.common);
    replay_command->callback([=, &line] {
        line.result = replay_or_play(line.common, arguments->command, arguments->no_window);
    });
}

void add_snapshot(CommandLine &line) {
    const auto arguments = std::make_shared<SnapshotArguments>();
    CLI::App *snapshot_command =
        line.app.add_subcommand("snapshot", "Draws scenes at given steps to numbered PNG files");
    add_scenes(*snapshot_command, line.common);
    auto *at = snapshot_command->add_option("--at", arguments->at, "Steps to draw: 0,60,240")
                   ->type_name("STEP,...");
    auto *every =
        snapshot_command->add_option("--every", arguments->every, "Draws every N-th step, from 0")
            ->check(positive())
            ->excludes(at);
    auto *steps =
        snapshot_command
            ->add_option("--steps", arguments->steps, "Steps to run; on its own, draws the last")
            ->check(step_range());
    every->needs(steps);
    snapshot_command->add_option("--size", line.common.size, "WIDTHxHEIGHT (1280x720)");
    add_out(*snapshot_command, line.common, "out");
    snapshot_command->add_flag("--ui", arguments->panels, "With the sandbox's panels");
    snapshot_command->add_option("--samples", arguments->samples, "Multisampling samples; 1: none")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    add_ui_scale(*snapshot_command, arguments->ui_scale, "1");
    add_run_options(*snapshot_command, line.common);
    add_gl(*snapshot_command, line.common);
    snapshot_command->callback([=, &line] { line.result = snapshot(line.common, *arguments); });
}

void add_list(CommandLine &line) {
    const auto arguments = std::make_shared<ListArguments>();
    CLI::App *list_command = line.app.add_subcommand("list", "Lists the scenes");
    list_command->add_flag("--json", arguments->json, "As JSON");
    auto *list_keys =
        list_command->add_flag("--keys", arguments->keys, "Keys and mouse instead, as a table");
    auto *list_settings =
        list_command->add_flag("--settings", arguments->settings, "Settings instead, as a table");
    list_command->add_flag("--methods", arguments->methods, "Methods instead")
        ->excludes(list_keys)
        ->excludes(list_settings);
    list_settings->excludes(list_keys);
    list_command->callback([=, &line] {
        list(arguments->keys       ? Listed::keys
             : arguments->methods  ? Listed::methods
             : arguments->settings ? Listed::settings
                                   : Listed::scenes,
             arguments->json, line.common.catalogue, std::cout);
    });
}

void add_hash(CommandLine &line) {
    const auto steps = std::make_shared<std::uint64_t>(0);
    CLI::App *hash_command = line.app.add_subcommand(
        "hash", "Prints a hash of the state: equal states have equal hashes");
    add_scenes(*hash_command, line.common);
    hash_command->add_option("--steps", *steps, "Steps to run first")
        ->check(step_range())
        ->required();
    add_run_options(*hash_command, line.common);
    hash_command->callback([=, &line] {
        TaskPool tasks(line.common.threads);
        HashCommand command;
        command.scenes = line.common.scene_paths();
        command.run = line.common.run();
        command.steps = *steps;
        command.tasks = &tasks;
        line.result = code_of(hash_scenes(command, std::cout, std::cerr));
    });
}

void add_compare(CommandLine &line) {
    const auto arguments = std::make_shared<CompareArguments>();
    CLI::App *compare_command = line.app.add_subcommand("compare", "Compares two PNG files");
    compare_command->add_option("A", arguments->a)->required();
    compare_command->add_option("B", arguments->b)->required();
    compare_command
        ->add_option("--tolerance", arguments->tolerance, "Largest channel difference that passes")
        ->check(CLI::Range(0, 255))
        ->capture_default_str();
    compare_command->add_option("--difference", arguments->difference,
                                "PNG file to write a picture of the difference to");
    compare_command->callback([=, &line] {
        line.result =
            compare(arguments->a, arguments->b, arguments->tolerance, arguments->difference);
    });
}

} // namespace plumb
