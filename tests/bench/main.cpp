// plumb-bench: run by `plumb bench`, which checks the arguments: WHAT ROUNDS OUT_DIR SHADER_DIR
// SECONDS SIZE THREADS ONLY..., with SECONDS 0 for each scene's own.
#include "app/lab/interrupt.h"
#include "tests/bench/benches.h"

#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>

namespace plumb {

namespace {

int bench(const std::vector<std::string> &arguments) {
    constexpr std::size_t fixed = 7;
    if (arguments.size() < fixed)
        throw std::invalid_argument("it is run by `plumb bench`");
    const std::string &what = arguments[0];
    EngineBenchOptions options;
    options.out_dir = arguments[2];
    if (const double seconds = std::stod(arguments[4]); seconds > 0)
        options.seconds = seconds;
    options.size = std::stod(arguments[5]);
    options.threads = std::stoi(arguments[6]);
    options.only.assign(arguments.begin() + fixed, arguments.end());

    ExitCode code = ExitCode::bad_input;
    if (what == "geometry")
        code = bench_geometry(std::stoi(arguments[1]), arguments[2], arguments[3]);
    else if (what == "dynamics")
        code = bench_dynamics(options);
    else if (what == "scenes")
        code = bench_scene_files(options);
    else if (what == "truth")
        code = bench_truth(options);
    else if (what == "problems")
        code = bench_problem_files(options);
    else
        throw std::invalid_argument(
            R"(there are "geometry", "dynamics", "scenes", "truth" and "problems", got ")" + what +
            '"');
    return InterruptGuard::requested() ? InterruptGuard::exit_code() : static_cast<int>(code);
}

} // namespace

} // namespace plumb

int main(int argc, char **argv) {
    try {
        return plumb::bench({argv + 1, argv + argc});
    } catch (const std::exception &error) {
        std::cerr << "plumb bench: " << error.what() << '\n';
        return static_cast<int>(plumb::ExitCode::bad_input);
    }
}
