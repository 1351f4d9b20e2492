// `plumb bench truth`: a table of small problems, with the aim and each engine's result.
#include "tests/bench/benches.h"

#include "app/files/output_file.h"
#include "app/lab/csv.h"
#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "tests/bench/only.h"
#include "tests/bench/truth.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>

namespace plumb {

namespace {

struct Answer {
    double error = std::numeric_limits<double>::quiet_NaN();
    std::string text;
};

Answer ask(const Problem &problem, const EngineKind &kind) {
    Answer answer;
    try {
        answer.error = problem.error(kind);
        char text[32];
        std::snprintf(text, sizeof text, "%.3g", answer.error);
        answer.text = text;
    } catch (const CannotRun &) {
        answer.text = "-";
    } catch (const Diverged &) {
        answer.error = std::numeric_limits<double>::infinity();
        answer.text = "diverges";
    }
    return answer;
}

} // namespace

ExitCode bench_truth(const EngineBenchOptions &options) {
    const std::vector<Problem> problems = chosen(all_problems(), options.only);
    const std::vector<EngineKind> kinds = engines(nullptr);

    create_folder(options.out_dir);
    const InterruptGuard interrupt;
    ProgressLine line(std::cerr);
    OutputFile file(options.out_dir / "bench_truth.csv");
    CsvWriter csv(file.stream());
    csv.cell("problem").cell("what").cell("unit").cell("aim");
    std::printf("%-16s %-58s %9s", "problem", "error of", "aim");
    for (const EngineKind &kind : kinds) {
        csv.cell(kind.name);
        std::printf(" %9s", kind.name.c_str());
    }
    csv.end_row();
    std::printf("\n");

    std::vector<std::string> missed;
    std::size_t done = 0;
    for (const Problem &problem : problems) {
        std::vector<Answer> answers;
        try {
            for (const EngineKind &kind : kinds) {
                line.show(static_cast<double>(done++) /
                              static_cast<double>(problems.size() * kinds.size()),
                          problem.name + ", " + kind.name);
                answers.push_back(ask(problem, kind));
            }
        } catch (const Interrupted &) {
            line.clear();
            std::cerr << "interrupted within " << problem.name
                      << "; of the problems before: " << file.keep_partial().string() << '\n';
            return ExitCode::fine;
        }
        line.clear();
        csv.cell(problem.name).cell(problem.what).cell(problem.unit).cell(problem.aim);
        char aim[32];
        std::snprintf(aim, sizeof aim, "%g %s", problem.aim, problem.unit.c_str());
        std::printf("%-16s %-58s %9s", problem.name.c_str(), problem.what.c_str(), aim);
        for (const Answer &answer : answers) {
            csv.cell(answer.error);
            std::printf(" %9s", answer.text.c_str());
        }
        csv.end_row();
        const bool is_missed = !(answers.front().error <= problem.aim);
        std::printf("%s\n", is_missed ? "  not reached" : "");
        std::fflush(stdout);
        if (is_missed)
            missed.push_back(problem.name);
    }
    std::printf("\nevery engine at its defaults, 60 Hz, sleeping off; the same measures of poses "
                "and velocities for all\n");
    std::printf("%zu of %zu aims reached\n", problems.size() - missed.size(), problems.size());
    std::fflush(stdout);
    file.finish();
    std::cerr << "wrote " << file.path().string() << '\n';
    return ExitCode::fine;
}

} // namespace plumb
