// `plumb bench geometry`: the same queries in several libraries, timed in turns.
#include "tests/bench/benches.h"

#include "app/files/output_file.h"
#include "app/lab/chart/chart_image.h"
#include "app/lab/csv.h"
#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/timing.h"
#include "app/render/context.h"
#include "app/render/png.h"
#include "tests/bench/contest.h"
#include "tests/bench/trees.h"

#include <cstdio>
#include <iostream>
#include <string>

namespace plumb {

namespace {

// The cores hardly ever run at a constant speed, so only numbers from one run are compared.
void print_contests(const std::vector<Contest> &contests,
                    const std::vector<std::vector<double>> &times, std::ostream &csv_out) {
    CsvWriter csv(csv_out);
    for (const char *name : {"query", "ours", "ours_cpu_ns", "ours_yes", "other", "other_cpu_ns",
                             "other_yes", "times_faster", "aim"})
        csv.cell(name);
    csv.end_row();
    std::printf("%-38s %10s   %-22s %10s %8s %6s\n", "CPU time of a query", "Plumb ns", "other",
                "ns", "ratio", "aim");
    std::vector<std::string> missed;
    std::size_t work = 0;
    for (const Contest &contest : contests) {
        const auto batch = static_cast<double>(contest.batch);
        const std::vector<double> &ours = times[work++];
        const std::uint64_t yes = contest.ours.answer_all();
        if (contest.others.empty())
            std::printf("%-38s %10.1f\n", contest.name.c_str(), 1e9 * median(ours) / batch);
        for (const Entrant &other : contest.others) {
            const std::vector<double> &theirs = times[work++];
            const std::uint64_t their_yes = other.answer_all();
            const double ratio = median_ratio(theirs, ours);
            const bool is_book = other.name == "the book's";
            const double aim = is_book ? 0 : contest.aim;
            std::printf("%-38s %10.1f   %-22s %10.1f %8.2f", contest.name.c_str(),
                        1e9 * median(ours) / batch, other.name.c_str(),
                        1e9 * median(theirs) / batch, ratio);
            if (aim > 0)
                std::printf(" %6.1f%s", aim, ratio < aim ? "  not reached" : "");
            if (yes != their_yes)
                std::printf("  (yes: %llu, theirs %llu, of %zu)",
                            static_cast<unsigned long long>(yes),
                            static_cast<unsigned long long>(their_yes), contest.batch);
            std::printf("\n");
            if (ratio < aim)
                missed.push_back(contest.name + " against " + other.name);
            csv.cell(contest.name)
                .cell(contest.ours.name)
                .cell(1e9 * median(ours) / batch)
                .cell(yes)
                .cell(other.name)
                .cell(1e9 * median(theirs) / batch)
                .cell(their_yes)
                .cell(ratio)
                .cell(aim);
            csv.end_row();
        }
    }
    std::printf("\nratio: how many times faster Plumb is; the median of ratios within one round\n");
    if (missed.empty())
        std::printf("every aim was reached\n");
    else
        std::printf("%zu aims were not reached:\n", missed.size());
    for (const std::string &one : missed)
        std::printf("  %s\n", one.c_str());
}

} // namespace

ExitCode bench_geometry(int rounds, const std::filesystem::path &out_dir,
                        const std::filesystem::path &shader_dir) {
    create_folder(out_dir);
    const InterruptGuard interrupt;
    ProgressLine line(std::cerr);
    TimingOptions timing;
    timing.rounds = rounds;
    timing.stop = InterruptGuard::requested;

    line.show(0, "building meshes");
    std::vector<Contest> contests = ray_contests();
    for (auto more : {pair_contests(), batch_contests(), mesh_contests(1'000'000)})
        contests.insert(contests.end(), more.begin(), more.end());
    std::vector<std::function<std::uint64_t()>> works;
    std::vector<std::string> names;
    for (const Contest &contest : contests) {
        works.push_back(contest.ours.answer_all);
        names.push_back(contest.name);
        for (const Entrant &other : contest.others) {
            works.push_back(other.answer_all);
            names.push_back(contest.name);
        }
    }
    timing.progress = [&](double fraction, std::size_t which) {
        line.show(0.7 * fraction, names[which]);
    };
    const std::vector<std::vector<double>> times = time_interleaved(works, timing);
    line.clear();
    OutputFile csv(out_dir / "bench_geometry.csv");
    print_contests(contests, times, csv.stream());
    std::fflush(stdout);
    if (InterruptGuard::requested()) {
        std::cerr << "interrupted; of the rounds that were finished: "
                  << csv.keep_partial().string() << '\n';
        return ExitCode::fine;
    }
    csv.finish();
    std::cerr << "wrote " << csv.path().string() << '\n';

    timing.rounds = std::min(rounds, 3);
    timing.progress = [&](double fraction, std::size_t) {
        line.show(0.7 + 0.3 * fraction, "trees");
    };
    const std::vector<TreeCost> trees = time_trees(1'000'000, timing);
    line.clear();
    print(std::cout << '\n', trees);
    OutputFile tree_csv(out_dir / "bench_trees.csv");
    write_tree_csv(tree_csv.stream(), trees);
    if (InterruptGuard::requested())
        return ExitCode::fine;
    tree_csv.finish();
    std::cerr << "wrote " << tree_csv.path().string() << '\n';
    try {
        const std::filesystem::path picture = out_dir / "bench_trees.png";
        write_png(picture,
                  ChartPainter(shader_dir).paint(tree_chart(trees, "plumb bench geometry")));
        std::cerr << "wrote " << picture.string() << '\n';
    } catch (const ContextError &failure) {
        std::cerr << "no picture: " << failure.what() << '\n';
        return ExitCode::no_gl_context;
    }
    return ExitCode::fine;
}

} // namespace plumb
