#include "app/lab/chart/chart.h"

#include "app/files/output_file.h"
#include "app/lab/chart/chart_image.h"
#include "app/lab/chart/chart_rows.h"
#include "app/lab/chart/chart_svg.h"
#include "app/lab/interrupt.h"
#include "app/lab/partial_table.h"
#include "app/lab/run/load_scenes.h"
#include "app/lab/run/method_choice.h"
#include "app/render/context.h"
#include "app/render/png.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace plumb {

namespace {

// Makes its painter on first use; if that fails, does not try again.
class LazyPainter {
  public:
    explicit LazyPainter(std::filesystem::path shader_dir) : shader_dir_(std::move(shader_dir)) {}

    // Null when there is no GL context; says so once.
    ChartPainter *get(std::ostream &err) {
        if (!painter_ && !failed_) {
            try {
                painter_ = std::make_unique<ChartPainter>(shader_dir_);
            } catch (const ContextError &error) {
                failed_ = true;
                err << "no pictures: " << error.what() << '\n';
            }
        }
        return painter_.get();
    }

  private:
    std::filesystem::path shader_dir_;
    std::unique_ptr<ChartPainter> painter_;
    bool failed_ = false;
};

// The prefix of all of a chart's file names.
std::filesystem::path stem_of(const std::filesystem::path &folder, const std::string &scene,
                              bool convergence, bool one_step) {
    return folder / (scene + (convergence ? ".convergence" : one_step ? ".one-step" : ""));
}

// SCENE.png and SCENE.svg, or SCENE.partial.png.
ExitCode write_pictures(const SceneChart &chart, const std::filesystem::path &stem,
                        const std::string &command, LazyPainter &painter, std::ostream &err) {
    const ChartContent content = chart_content(chart, command);
    if (!chart.interrupted) {
        std::filesystem::remove(stem.string() + ".partial.png");
        OutputFile svg(stem.string() + ".svg");
        write_chart_svg(svg.stream(), content);
        svg.finish();
        err << "wrote " << svg.path().string() << '\n';
    }
    ChartPainter *pen = painter.get(err);
    if (pen == nullptr)
        return ExitCode::no_gl_context;
    const std::string picture = stem.string() + (chart.interrupted ? ".partial.png" : ".png");
    write_png(picture, pen->paint(content));
    err << "wrote " << picture << '\n';
    return ExitCode::fine;
}

// The chart's exit code, fine if any run has a result. Reports on `err` if no method can run the
// scene.
ExitCode code_of(const SceneChart &chart, std::ostream &err) {
    if (chart.runs.empty() && chart.planned == 0) {
        err << chart.scene.name << ": " << why_no_method(chart.left_out) << '\n';
        return ExitCode::bad_input;
    }
    const bool any = std::ranges::any_of(
        chart.runs, [](const ChartRun &run) { return std::isfinite(run.error); });
    if (any || chart.runs.empty() || chart.interrupted)
        return ExitCode::fine;
    const bool all_diverged = std::ranges::all_of(
        chart.runs, [](const ChartRun &run) { return run.run.divergence.has_value(); });
    return all_diverged ? ExitCode::diverged : ExitCode::outside_tolerance;
}

// A finished scene, kept while others are still to run.
struct Charted {
    PartialTable earlier;
    std::string table, others; // `others`: rows of `earlier` that are not in `table`

    // The command completed: earlier rows are obsolete, except those of other commands.
    void finish() const { earlier.keep_only(others); }
    // The command was interrupted: keeps this scene too, so that resuming does not run it again.
    void keep() const {
        if (earlier.place().empty())
            return;
        OutputFile file(earlier.place());
        file.stream() << table << others;
        file.finish();
    }
};

ExitCode chart_one(const SceneDesc &scene, const ChartCommand &command, LazyPainter &painter,
                   ProgressLine &line, std::vector<Charted> &charted, std::ostream &out,
                   std::ostream &err) {
    ChartOptions options = command.options;
    options.stop = InterruptGuard::requested;
    options.progress = [&](double fraction, const std::string &what) { line.show(fraction, what); };
    const Shard &shard = options.shard;
    const std::filesystem::path stem =
        stem_of(command.out_dir, scene.name, options.convergence, options.one_step);
    std::string table = stem.string();
    if (shard.of > 1)
        table += "." + std::to_string(shard.n) + "-of-" + std::to_string(shard.of);
    OutputFile csv(table + ".csv");
    const std::string fingerprint = chart_fingerprint(scene, options);
    PartialTable earlier(csv.partial_place());
    std::istringstream known(earlier.text());
    options.known = read_known_runs(known, scene, fingerprint);
    const bool goes_on = !options.known.empty();
    if (goes_on)
        err << "resuming from " << earlier.place().string() << '\n';
    const SceneChart chart = chart_scene(scene, options);
    line.clear();
    ExitCode code = code_of(chart, err);
    if (code == ExitCode::bad_input)
        return code; // an earlier chart stays
    std::ostringstream rows;
    write_chart_csv(rows, chart, fingerprint);
    const std::string others = earlier.rows_not_in(rows.str(), chart_key_columns(), "fingerprint");
    csv.stream() << rows.str();
    if (chart.interrupted) {
        csv.stream() << others;
        err << "interrupted; rows so far: " << csv.keep_partial().string() << '\n';
    } else {
        csv.finish();
        err << "wrote " << csv.path().string() << '\n';
        charted.push_back({std::move(earlier), rows.str(), others});
    }
    if (!chart.runs.empty() && shard.of == 1)
        code = worse(code, write_pictures(chart, stem, command.command, painter, err));
    print(out, chart); // last, as its reader may close the pipe
    out << std::flush;
    return code;
}

} // namespace

ExitCode chart_scenes(const ChartCommand &command, std::ostream &out, std::ostream &err) {
    const RunOptions &given = command.options.base;
    for (const SweepAxis &axis : sweep_of(command.options))
        refuse_given(axis.setting, given.settings);
    if (given.precision && !command.options.precisions.empty())
        throw std::invalid_argument("precision is both given and swept: drop one of them");
    const LoadedScenes loaded = load_scenes(command.scenes, err);
    ExitCode code = loaded.all_fine ? ExitCode::fine : ExitCode::bad_input;
    std::set<std::string> names;
    for (const SceneDesc &scene : loaded.scenes)
        if (!names.insert(scene.name).second) {
            err << "two scenes are called " << scene.name << "; chart them into two folders\n";
            return ExitCode::bad_input;
        }
    // Scenes without motion are skipped if others have some.
    const bool any_moves = std::ranges::any_of(loaded.scenes, has_world);
    if (any_moves)
        create_folder(command.out_dir);
    else
        code = ExitCode::bad_input;

    const InterruptGuard interrupt;
    ProgressLine line(err);
    LazyPainter painter(command.shader_dir);
    std::vector<Charted> charted;
    for (const SceneDesc &scene : loaded.scenes) {
        if (InterruptGuard::requested())
            break;
        if (!has_world(scene)) {
            (any_moves ? out << "-     " : err)
                << scene.name << ": only probes, no motion to chart\n";
            continue;
        }
        try {
            code = worse(code, chart_one(scene, command, painter, line, charted, out, err));
        } catch (const std::invalid_argument &failure) {
            line.clear();
            err << scene.name << ": " << failure.what() << '\n';
            code = worse(code, ExitCode::bad_input);
        }
    }
    for (const Charted &each : charted)
        if (InterruptGuard::requested())
            each.keep();
        else
            each.finish();
    return code;
}

namespace {

// The tables of one scene.
ExitCode merge_chart(const MergeCommand &command, const std::vector<NamedTable> &tables,
                     LazyPainter &painter, std::ostream &out, std::ostream &err) {
    const std::filesystem::path scene =
        command.scene.empty() ? command.find_scene(scene_of_chart(tables[0].text)) : command.scene;
    const LoadedScenes loaded = load_scenes({scene}, err);
    if (!loaded.all_fine || loaded.scenes.size() != 1)
        return ExitCode::bad_input;
    const SceneChart chart = merged_chart(loaded.scenes.front(), tables);
    if (chart.runs.size() < chart.planned) {
        err << "merge: only " << chart.runs.size() << " of " << chart.planned << " runs of "
            << chart.scene.name << " are in these tables; nothing is written\n";
        return ExitCode::bad_input;
    }
    create_folder(command.out_dir);
    const std::filesystem::path stem =
        stem_of(command.out_dir, chart.scene.name, chart.convergence, chart.steps_from.has_value());
    OutputFile csv(stem.string() + ".csv");
    write_chart_csv(csv.stream(), chart);
    csv.finish();
    print(out, chart);
    out << std::flush;
    err << "wrote " << csv.path().string() << '\n';
    return worse(code_of(chart, err), write_pictures(chart, stem, command.command, painter, err));
}

} // namespace

ExitCode merge_charts(const MergeCommand &command, std::ostream &out, std::ostream &err) {
    std::map<std::string, std::vector<NamedTable>> of_scene;
    for (const std::filesystem::path &path : command.tables) {
        std::ifstream in(path, std::ios::binary);
        if (!in)
            throw std::invalid_argument("cannot read " + path.string());
        NamedTable table{path.string(), {std::istreambuf_iterator<char>(in), {}}};
        const std::string scene = scene_of_chart(table.text);
        if (scene.empty())
            throw std::invalid_argument(path.string() +
                                        " is not a table from `plumb chart`, or has no rows");
        of_scene[scene].push_back(std::move(table));
    }
    if (!command.scene.empty() && of_scene.size() > 1)
        throw std::invalid_argument(
            "--scene is of one scene, but " + of_scene.rbegin()->second.front().name + " is from " +
            of_scene.rbegin()->first + " and " + of_scene.begin()->second.front().name + " from " +
            of_scene.begin()->first);
    LazyPainter painter(command.shader_dir);
    ExitCode code = ExitCode::fine;
    for (const auto &[scene, tables] : of_scene)
        code = worse(code, merge_chart(command, tables, painter, out, err));
    return code;
}

} // namespace plumb
