#include "app/lab/chart/chart.h"

#include "app/files/output_file.h"
#include "app/lab/chart/chart_image.h"
#include "app/lab/interrupt.h"
#include "app/lab/run/load_scenes.h"
#include "app/render/context.h"
#include "app/render/png.h"

#include <cmath>
#include <set>
#include <stdexcept>

namespace plumb {

namespace {

// Makes its painter when first asked, and remembers that there is none.
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

} // namespace

ExitCode chart_scenes(const ChartCommand &command, std::ostream &out, std::ostream &err) {
    namespace fs = std::filesystem;
    const LoadedScenes loaded = load_scenes(command.scenes, err);
    ExitCode code = loaded.all_fine ? ExitCode::fine : ExitCode::bad_input;
    std::set<std::string> names;
    for (const SceneDesc &scene : loaded.scenes)
        if (!names.insert(scene.name).second) {
            err << "two scenes are called " << scene.name << "; chart them into two folders\n";
            return ExitCode::bad_input;
        }
    create_folder(command.out_dir);

    const InterruptGuard interrupt;
    ProgressLine line(err);
    LazyPainter painter(command.shader_dir);
    for (const SceneDesc &scene : loaded.scenes) {
        if (InterruptGuard::requested())
            break;
        if (!has_world(scene)) {
            out << "-     " << scene.name << ": only probes, and no motion to chart\n";
            continue;
        }
        try {
            ChartOptions options = command.options;
            options.stop = InterruptGuard::requested;
            options.progress = [&](double fraction, const std::string &what) {
                line.show(fraction, what);
            };
            OutputFile csv(command.out_dir / (scene.name + ".csv"));
            const SceneChart chart = chart_scene(scene, options);
            line.clear();
            write_chart_csv(csv.stream(), chart);
            print(out, chart);
            out << std::flush;
            bool any_result = false;
            for (const ChartRun &run : chart.runs)
                any_result = any_result || std::isfinite(run.error);
            if (!any_result && !chart.interrupted) {
                if (chart.runs.empty()) {
                    err << scene.name << ": no method can run this scene\n";
                    code = worse(code, ExitCode::bad_input);
                } else {
                    code = worse(code, ExitCode::diverged);
                }
            }
            if (chart.interrupted) {
                err << "interrupted; rows so far: " << csv.keep_partial().string() << '\n';
            } else {
                csv.finish();
                err << "wrote " << csv.path().string() << '\n';
            }
            if (chart.runs.empty())
                continue;
            if (ChartPainter *pen = painter.get(err)) {
                const fs::path picture =
                    command.out_dir / (scene.name + (chart.interrupted ? ".partial.png" : ".png"));
                write_png(picture, pen->paint(chart_content(chart, command.command)));
                err << "wrote " << picture.string() << '\n';
            } else {
                code = worse(code, ExitCode::no_gl_context);
            }
        } catch (const std::invalid_argument &failure) {
            line.clear();
            err << scene.name << ": " << failure.what() << '\n';
            code = worse(code, ExitCode::bad_input);
        }
    }
    return code;
}

} // namespace plumb
