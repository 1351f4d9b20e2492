#include "app/lab/queries/query_chart.h"

#include "app/files/output_file.h"
#include "app/lab/chart/chart_image.h"
#include "app/lab/chart/chart_svg.h"
#include "app/lab/interrupt.h"
#include "app/render/context.h"
#include "app/render/png.h"

#include <iostream>

namespace plumb {

ExitCode chart_geometry(const QueryChartCommand &command, std::ostream &out, std::ostream &err) {
    create_folder(command.out_dir);
    const InterruptGuard interrupt;
    ProgressLine line(err);
    QueryChartOptions options = command.options;
    options.stop = InterruptGuard::requested;
    options.progress = [&](double fraction, const std::string &what) { line.show(fraction, what); };

    OutputFile csv(command.out_dir / "geometry.csv");
    const QueryChart chart = chart_queries(options);
    line.clear();
    write_query_csv(csv.stream(), chart);
    print(out, chart);
    out << std::flush;
    if (chart.interrupted) {
        err << "interrupted; rows so far: " << csv.keep_partial().string() << '\n';
        return ExitCode::fine;
    }
    csv.finish();
    err << "wrote " << csv.path().string() << '\n';
    const PanelChart panels = panel_chart(chart, command.command);
    OutputFile svg(command.out_dir / "geometry.svg");
    write_chart_svg(svg.stream(), panels);
    svg.finish();
    err << "wrote " << svg.path().string() << '\n';
    try {
        const std::filesystem::path picture = command.out_dir / "geometry.png";
        write_png(picture, ChartPainter(command.shader_dir).paint(panels));
        err << "wrote " << picture.string() << '\n';
    } catch (const ContextError &failure) {
        err << "no picture: " << failure.what() << '\n';
        return ExitCode::no_gl_context;
    }
    return ExitCode::fine;
}

} // namespace plumb
