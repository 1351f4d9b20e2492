// Commands that chart cost against error.
#include "app/commands.h"

#include "app/lab/chart/chart.h"
#include "app/lab/engines/other_engines.h"
#include "app/lab/queries/query_chart.h"
#include "app/lab/tune/tune.h"

#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace plumb {

namespace {

// A chart of geometric queries steps no world, so it would silently ignore these options.
void refuse_options_of_scenes(const CLI::App &chart_command) {
    for (const CLI::Option *option : chart_command.get_options())
        if (option->count() > 0 && option->get_name() != "SCENE" &&
            option->get_name() != "--repeats" && option->get_name() != "--out")
            throw std::invalid_argument("chart geometry takes only --repeats and --out, not " +
                                        option->get_name());
}

struct ChartArguments {
    ChartCommand command;
    std::vector<std::string> sweeps;
    std::string methods, engines, budget, shard;
};

// "2/4"
Shard parse_shard(const std::string &text) {
    Shard shard;
    char slash = 0;
    std::istringstream in(text);
    if (!(in >> shard.n >> slash >> shard.of) || slash != '/' || !in.eof() || shard.n < 1 ||
        shard.n > shard.of)
        throw std::invalid_argument("--shard: '" + text +
                                    "' must be I/N with I from 1 to N, as in 2/4 for the second "
                                    "of four parts");
    return shard;
}

} // namespace

void add_chart(CommandLine &line) {
    const auto arguments = std::make_shared<ChartArguments>();
    CLI::App *chart_command = line.app.add_subcommand(
        "chart",
        "Charts each method's cost against its error, as CSV, PNG and SVG: of scenes, or of "
        "geometric queries (`plumb chart geometry`, which takes only --repeats and --out)");
    add_scenes(*chart_command, line.common);
    chart_command->add_option("--methods", arguments->methods, "Methods (all): " + method_names())
        ->type_name("METHOD,...");
    chart_command
        ->add_option("--sweep", arguments->sweeps,
                     "Setting to sweep, any from `plumb list --settings`: substeps=1..16 (the "
                     "default), iterations=1,2,8, dt=1/240..1/30; also precision=float,double and "
                     "threads=1,2 (then in wall time); may be repeated")
        ->allow_extra_args(false);
    chart_command->add_option(
        "--expect", arguments->command.options.expect,
        "Name of one expectation to chart, in its own unit (the worst of all, "
        "each in units of its own tolerance; with --convergence of those of a value at a given "
        "time)");
    chart_command
        ->add_option("--repeats", arguments->command.options.repeats, "Timings of each run")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    chart_command
        ->add_option(
            "--with", arguments->engines,
            "Other engines to chart beside the methods, by the same measures: bullet, ode (in a "
            "build with PLUMB_BENCH=ON); nothing sleeps then unless sleep_after is given")
        ->type_name("ENGINE,...");
    chart_command
        ->add_option("--budget", arguments->budget,
                     "Time a frame of 1/60 s may cost, drawn as a line (all of it: 60 Hz)")
        ->type_name("1ms");
    chart_command->add_flag("--convergence", arguments->command.options.convergence,
                            "Error against dt with fitted orders, untimed: in double, with one "
                            "substep, over dt=1/960..1/30 unless --sweep says otherwise");
    chart_command->add_flag(
        "--one-step", arguments->command.options.one_step,
        "For chaotic motion: the error of one step (of a 60 Hz frame, if that is longer) from "
        "states of one accurate run in double, the same for every method");
    chart_command
        ->add_option("--seed", arguments->command.options.seed,
                     "Random seed for the order of the timings in each round")
        ->capture_default_str();
    chart_command
        ->add_option("--shard", arguments->shard,
                     "Runs part I of N of a chart, without pictures, for `plumb merge`")
        ->type_name("I/N");
    add_out(*chart_command, line.common, "out");
    add_run_options(*chart_command, line.common, true);
    chart_command->callback([=, &line] {
        if (line.common.scenes == std::vector<std::string>{"geometry"}) {
            refuse_options_of_scenes(*chart_command);
            QueryChartCommand command;
            command.options.repeats = arguments->command.options.repeats;
            command.out_dir = line.common.out;
            command.shader_dir = line.common.shader_dir();
            command.command = line.text;
            line.result = code_of(chart_geometry(command, std::cout, std::cerr));
            return;
        }
        for (const std::string &sweep : arguments->sweeps)
            add_sweep(arguments->command.options, sweep);
        if (!arguments->engines.empty())
            arguments->command.options.engines = find_other_engines(parse_list(arguments->engines));
        if (!arguments->budget.empty())
            arguments->command.options.budget = parse_budget(arguments->budget);
        if (!arguments->shard.empty())
            arguments->command.options.shard = parse_shard(arguments->shard);
        if (!arguments->methods.empty())
            arguments->command.options.methods = parse_list(arguments->methods);
        arguments->command.scenes = line.common.scene_paths();
        arguments->command.options.base = line.common.run();
        GivenSettings &given = arguments->command.options.base.settings;
        // The other engines never sleep: what does would cost nothing beside them.
        if (!arguments->engines.empty() && !given.find(find_setting_numbers("sleep_after").front()))
            given.give(&StepSettings::sleep_after, 0.0);
        arguments->command.out_dir = line.common.out;
        arguments->command.shader_dir = line.common.shader_dir();
        arguments->command.command = line.text;
        line.result = code_of(chart_scenes(arguments->command, std::cout, std::cerr));
    });
}

void add_merge(CommandLine &line) {
    const auto command = std::make_shared<MergeCommand>();
    CLI::App *merge_command = line.app.add_subcommand(
        "merge", "Merges the tables written by `plumb chart --shard` into one chart per scene");
    merge_command->add_option("CSV", command->tables, "All the tables, in any order")->required();
    merge_command->add_option("--scene", command->scene,
                              "The scene's file, if `plumb list` does not have it");
    add_out(*merge_command, line.common, "out");
    merge_command->callback([=, &line] {
        command->find_scene = [&line](const std::string &name) {
            return resolve_scene(name, line.common.catalogue);
        };
        command->out_dir = line.common.out;
        command->shader_dir = line.common.shader_dir();
        command->command = line.text;
        line.result = code_of(merge_charts(*command, std::cout, std::cerr));
    });
}

} // namespace plumb
