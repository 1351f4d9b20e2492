// Truths by refinement: against closed forms, against those in the scenes, and written to a file.
#include "app/lab/run/reference.h"

#include "engine/scene/expect.h"
#include "engine/scene/scene_file.h"
#include "tests/temporary_folder.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

// The bob hangs on a soft joint of 1 Hz and falls by sag (1 - cos w t), sag = g / w^2: the full sag
// after a quarter period.
std::string sagging(const std::string &equals, const std::string &estimate) {
    return R"([[body]]
name = "bob"
shape = "sphere"
radius = 0.1
[[joint]]
name = "rope"
type = "ball"
body_b = "bob"
anchor = [0, 0, 0]
frequency = 1
damping_ratio = 0
[[expect]]
name = "way"
quantity = "displacement"
body = "bob"
to = 0.25
equals = )" +
           equals + " # m\ntolerance = 1e-4\nestimate = " + estimate +
           "\nsource = \"by refinement\"\n";
}
const double sagging_truth = 9.81 / (4 * std::numbers::pi * std::numbers::pi);

// Its displacement over time, with window edges that fall between steps.
std::string sagging_curve(const std::string &equals, const std::string &reduce) {
    return sagging("0", "0").substr(0, sagging("0", "0").find("[[expect]]")) + R"([[expect]]
name = "way"
quantity = "displacement"
body = "bob"
reduce = ")" +
           reduce + R"("
from = 0.123
to = 1.456
equals = )" +
           equals + " # m\ntolerance = 1e-3\nestimate = 0\nsource = \"by refinement\"\n";
}

class Reference : public testing::Test {
  protected:
    ExitCode command(bool write) {
        out_.str("");
        ReferenceCommand command;
        command.scene = folder_ / "sag.toml";
        command.write = write;
        return refine_scene(command, out_, err_);
    }
    void put(const std::string &text) const { std::ofstream(folder_ / "sag.toml") << text; }
    [[nodiscard]] std::string text() const {
        std::ostringstream text;
        text << std::ifstream(folder_ / "sag.toml").rdbuf();
        return text.str();
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
    std::ostringstream out_, err_;
};

TEST(Refinement, SettlesAtClosedFormsWithinItsEstimate) {
    const SceneDesc scene = parse_scene(sagging("1", "0"), "sag.toml").scene;
    const std::vector<RefinedTruth> truths = refine(scene);
    ASSERT_EQ(truths.size(), 1U);
    EXPECT_TRUE(truths[0].settled());
    EXPECT_FALSE(truths[0].agrees());
    EXPECT_EQ(truths[0].run.precision, Precision::f64);
    EXPECT_LE(truths[0].run.settings.dt, 1.0 / 120);
    EXPECT_LT(truths[0].estimate, 1e-5);
    EXPECT_NEAR(truths[0].value, sagging_truth, truths[0].estimate);
    EXPECT_GT(truths[0].estimate, 0);
}

TEST(Refinement, OfACurveSettlesAtTheClosedFormWithAboutAsFewValuesAsItTakes) {
    const SceneDesc scene = parse_scene(sagging_curve("[0, 0, 0, 0]", "max"), "sag.toml").scene;
    const std::vector<RefinedTruth> truths = refine(scene);
    ASSERT_EQ(truths.size(), 1U);
    const RefinedTruth &truth = truths[0];
    EXPECT_TRUE(truth.settled());
    EXPECT_FALSE(truth.agrees());
    EXPECT_NEAR(truth.value, 2 * sagging_truth, 1e-3); // from a curve that stays at 0
    // Off by 1/20 of the tolerance at intervals of at most (5e-5 * 24 / (sag w^4))^(1/4) = 0.03 s.
    EXPECT_GT(truth.curve.size(), 30U);
    EXPECT_LT(truth.curve.size(), 50U);
    double error = 0;
    for (int i = 0; i <= 1000; ++i) {
        const double t = std::lerp(0.123, 1.456, i / 1000.0);
        error = std::max(error, std::abs(curve_at(truth.curve, 0.123, 1.456, t) -
                                         sagging_truth * (1 - std::cos(2 * std::numbers::pi * t))));
    }
    EXPECT_LT(error, truth.estimate);
    EXPECT_LT(truth.estimate, 1e-4);
}

TEST(Refinement, OfWhatDependsOnTheStepDoesNotSettle) {
    // A breaking joint breaks at the end of the first step, however short.
    const SceneFileResult file = load_scene(PLUMB_SOURCE_DIR "/scenes/joints/breaking.toml");
    RefineOptions options;
    options.halvings = 2;
    const std::vector<RefinedTruth> truths = refine(file.scene, options);
    ASSERT_EQ(truths.size(), 1U);
    EXPECT_FALSE(truths[0].settled());
    EXPECT_DOUBLE_EQ(truths[0].run.settings.dt, 1.0 / 240);
    options.only_estimated = true;
    EXPECT_TRUE(refine(file.scene, options).empty());
    options = {};
    options.stop = [] { return true; };
    EXPECT_TRUE(refine(file.scene, options).empty());
}

// Those without a closed form.
TEST(Refinement, OfTheScenesIsWhatTheyHave) {
    int count = 0;
    for (const fs::directory_entry &file :
         fs::recursive_directory_iterator(fs::path(PLUMB_SOURCE_DIR) / "scenes")) {
        if (file.path().extension() != ".toml")
            continue;
        RefineOptions options;
        options.only_estimated = true;
        for (const RefinedTruth &truth : refine(load_scene(file.path()).scene, options)) {
            EXPECT_TRUE(truth.settled()) << file.path() << truth.desc.name;
            EXPECT_NEAR(truth.value, truth.desc.value, *truth.desc.estimate)
                << file.path() << truth.desc.name;
            ++count;
        }
    }
    EXPECT_GE(count, 1);
}

// Two point masses of 1 kg on massless rods of 1 m, at angles a and b from the vertical, and their
// rates. Lagrange's equations:
//   2 a'' + cos(a - b) b'' + sin(a - b) b'^2 + 2 g sin a = 0
//   cos(a - b) a'' + b'' - sin(a - b) a'^2 + g sin b = 0
using Angles = std::array<double, 4>;

Angles change_of(const Angles &now) {
    const auto [a, b, a_rate, b_rate] = now;
    const double c = std::cos(a - b), s = std::sin(a - b);
    const double first = -s * b_rate * b_rate - 2 * 9.81 * std::sin(a);
    const double second = s * a_rate * a_rate - 9.81 * std::sin(b);
    const double determinant = 2 - c * c;
    return {a_rate, b_rate, (first - c * second) / determinant,
            (2 * second - c * first) / determinant};
}

// One Runge-Kutta step.
Angles stepped(const Angles &now, double h) {
    const auto ahead = [&](double way, const Angles &rate) {
        Angles there = now;
        for (std::size_t i = 0; i < there.size(); ++i)
            there[i] += way * rate[i];
        return there;
    };
    const Angles k1 = change_of(now), k2 = change_of(ahead(h / 2, k1)),
                 k3 = change_of(ahead(h / 2, k2)), k4 = change_of(ahead(h, k3));
    Angles mean{};
    for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] = (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) / 6;
    return ahead(h, mean);
}

// The curve in the scene came from the engine; this one is independent of it. Halving its step
// changes it by less than 1e-12 m.
TEST(Refinement, OfTheDoublePendulumIsWhatItsEquationsSay) {
    const SceneFileResult file = load_scene(PLUMB_SOURCE_DIR "/scenes/joints/double_pendulum.toml");
    const ExpectDesc &expect = file.scene.expects.at(0);
    ASSERT_FALSE(expect.curve.empty());
    ASSERT_TRUE(expect.estimate);
    constexpr int steps = 64; // from one value to the next
    const int last = static_cast<int>(expect.curve.size() - 1) * steps;
    const double h = expect.to / last;
    Angles now{std::numbers::pi / 4, std::numbers::pi / 2, 0, 0};
    double error = 0, error_at_values = 0;
    for (int i = 0; i <= last; ++i) {
        const double off = std::abs(curve_at(expect.curve, 0, expect.to, i * h) - std::sin(now[0]) -
                                    std::sin(now[1]));
        error = std::max(error, off);
        if (i % steps == 0)
            error_at_values = std::max(error_at_values, off);
        now = stepped(now, h);
    }
    EXPECT_LT(error, *expect.estimate);
    EXPECT_LT(error_at_values, *expect.estimate / 20); // nearly all of it is between them
}

TEST_F(Reference, IsSaidAndWrittenAndNothingElse) {
    put(sagging("1", "0"));
    EXPECT_EQ(command(false), ExitCode::outside_tolerance);
    EXPECT_NE(out_.str().find("OTHER sag/way: 0.2484"), std::string::npos) << out_.str();
    EXPECT_EQ(text(), sagging("1", "0"));

    EXPECT_EQ(command(true), ExitCode::fine) << err_.str();
    const ExpectDesc written = parse_scene(text(), "sag.toml").scene.expects.at(0);
    EXPECT_NEAR(written.value, sagging_truth, *written.estimate);
    std::ostringstream value, estimate;
    value << text().substr(text().find("equals = ") + 9,
                           text().find(" # m") - text().find("equals = ") - 9);
    estimate << text().substr(text().find("estimate = ") + 11,
                              text().find("\nsource") - text().find("estimate = ") - 11);
    EXPECT_EQ(text(), sagging(value.str(), estimate.str()));
    EXPECT_LE(value.str().size(), 12U) << "digits that say nothing";

    EXPECT_EQ(command(true), ExitCode::fine);
    EXPECT_NE(out_.str().find("Nothing to write"), std::string::npos) << out_.str();
    EXPECT_EQ(command(false), ExitCode::fine);
    EXPECT_NE(out_.str().find("ok    sag/way"), std::string::npos) << out_.str();
}

TEST_F(Reference, CurvesAreSaidAndWrittenAndNothingElse) {
    for (const std::string reduce : {"max", "mean"}) {
        put(sagging_curve("[0, 0, 0, 0]", reduce));
        EXPECT_EQ(command(false), ExitCode::outside_tolerance);
        EXPECT_NE(out_.str().find("OTHER sag/way: a curve of "), std::string::npos) << out_.str();
        EXPECT_EQ(command(true), ExitCode::fine) << err_.str();
        const std::string written = text();
        const std::size_t array = written.find("equals = ") + 9;
        const std::size_t estimate = written.find("estimate = ") + 11;
        std::string other =
            sagging_curve(written.substr(array, written.find(" # m") - array), reduce);
        other.replace(other.find("estimate = 0"), 12,
                      "estimate = " +
                          written.substr(estimate, written.find("\nsource") - estimate));
        EXPECT_EQ(written, other);

        EXPECT_EQ(command(true), ExitCode::fine);
        EXPECT_NE(out_.str().find("Nothing to write"), std::string::npos) << out_.str();
        EXPECT_EQ(command(false), ExitCode::fine);
        EXPECT_NE(out_.str().find("ok    sag/way"), std::string::npos) << out_.str();
    }
}

TEST_F(Reference, WithoutAnEstimateThereIsNoneToWrite) {
    std::string text = sagging("1", "0");
    text.erase(text.find("estimate"), text.find("source") - text.find("estimate"));
    put(text);
    EXPECT_THROW((void)command(true), std::invalid_argument);
    EXPECT_EQ(command(false), ExitCode::fine); // reported, and no more
    EXPECT_NE(out_.str().find("OTHER"), std::string::npos) << out_.str();
}

} // namespace
} // namespace plumb
