#include "app/lab/map/theory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

namespace plumb {

namespace {

constexpr int curve_points = 400;

// Explicit methods on an undamped oscillator; explicit Euler is stable at no step.
struct SpringLimit {
    double omega_h;
    std::string_view text;
    std::array<std::string_view, 3> methods;
};
constexpr std::array spring_limits{
    SpringLimit{2, "2", {"semi_implicit_euler", "stormer_verlet", "velocity_verlet"}},
    SpringLimit{2 * std::numbers::sqrt2, "2√2", {"rk4"}},
};

// Naive impulses only make contacts for overlapping bodies; the others also for approaching ones.
bool waits_for_overlap(const MethodInfo &method) {
    return method.name == "naive_impulses";
}

struct FlownAxis {
    std::string body; // name in the file, and prefix of its copies' names
    int axis = 0;
};

// "body.ball.velocity.x"
std::optional<FlownAxis> flown_axis(const MapAxis &axis) {
    constexpr std::string_view head = "body.", tail = ".velocity.";
    const std::string_view name = axis.name;
    const std::size_t end = name.rfind(tail);
    if (!name.starts_with(head) || end == std::string_view::npos || end <= head.size() ||
        end + tail.size() + 1 != name.size())
        return std::nullopt;
    const std::size_t component = std::string_view("xyz").find(name.back());
    if (component == std::string_view::npos)
        return std::nullopt;
    return FlownAxis{std::string(name.substr(head.size(), end - head.size())),
                     static_cast<int>(component)};
}

double restitution_of(const SceneDesc &scene, const BodyDesc &body) {
    const ColliderDesc &collider = body.colliders.front();
    const std::string &name = collider.material.empty() ? body.material : collider.material;
    const auto material = std::ranges::find(scene.materials, name, &MaterialDesc::name);
    return material == scene.materials.end() ? 0 : material->restitution;
}

bool in_line(const glm::dvec3 &a, const glm::dvec3 &b, int axis) {
    for (int other = 0; other < 3; ++other)
        if (other != axis && a[other] != b[other])
            return false;
    return true;
}

bool stands_across(const BoundsDesc &wall, const BoundsDesc &body, int axis) {
    for (int other = 0; other < 3; ++other)
        if (other != axis &&
            (wall.min[other] > body.min[other] || wall.max[other] < body.max[other]))
            return false;
    return true;
}

// Extent along the axis, positive in the direction of flight.
struct Span {
    double near = 0, far = 0;
    Span(const BoundsDesc &bounds, int axis, bool forwards)
        : near(forwards ? bounds.min[axis] : -bounds.max[axis]),
          far(forwards ? bounds.max[axis] : -bounds.min[axis]) {}
};

// The only such body; null if there are none or several.
template <typename Is> const BodyDesc *only_body(const SceneDesc &scene, const Is &is) {
    const BodyDesc *found = nullptr;
    for (const BodyDesc &body : scene.bodies)
        if (is(body)) {
            if (found != nullptr)
                return nullptr;
            found = &body;
        }
    return found;
}

} // namespace

std::optional<StruckBody> struck_before_wall(const SceneDesc &scene, const std::string &striker,
                                             int axis) {
    const auto hits = std::ranges::find(scene.bodies, striker, &BodyDesc::name);
    if (hits == scene.bodies.end() || hits->kind != BodyKind::dynamic ||
        hits->velocity[axis] == 0 || !in_line(hits->velocity, glm::dvec3(0), axis))
        return std::nullopt;
    const bool forwards = hits->velocity[axis] > 0;
    const Span own(bounds(*hits), axis, forwards);
    const BodyDesc *struck = only_body(scene, [&](const BodyDesc &body) {
        return body.kind == BodyKind::dynamic && &body != &*hits;
    });
    if (struck == nullptr || struck->velocity != glm::dvec3(0) ||
        !in_line(struck->position, hits->position, axis))
        return std::nullopt;
    const Span target(bounds(*struck), axis, forwards);
    const BodyDesc *wall =
        only_body(scene, [](const BodyDesc &body) { return body.kind != BodyKind::dynamic; });
    if (wall == nullptr || wall->kind != BodyKind::static_body || has_plane(*wall) ||
        !stands_across(bounds(*wall), bounds(*struck), axis))
        return std::nullopt;
    const Span behind(bounds(*wall), axis, forwards);
    if (!(own.far <= target.near && target.far <= behind.near) ||
        std::max(restitution_of(scene, *hits), restitution_of(scene, *struck)) > 0)
        return std::nullopt;
    const double heavy = mass_of(scene, *hits), light = mass_of(scene, *struck);
    return StruckBody{heavy / (heavy + light),
                      0.5 * (behind.near + behind.far) - 0.5 * (target.near + target.far)};
}

std::optional<double> way_into_wall(const SceneDesc &scene, const std::string &thrown, int axis) {
    const BodyDesc *wall =
        only_body(scene, [](const BodyDesc &body) { return body.kind != BodyKind::dynamic; });
    if (wall == nullptr || wall->kind != BodyKind::static_body || has_plane(*wall) ||
        !scene.joints.empty())
        return std::nullopt;
    std::optional<double> way;
    for (const BodyDesc &body : scene.bodies) {
        if (&body == wall)
            continue;
        const bool is_thrown = body.name == thrown || body.name.starts_with(thrown + "_");
        if (!is_thrown || body.velocity[axis] == 0 ||
            !in_line(body.velocity, glm::dvec3(0), axis) ||
            !stands_across(bounds(*wall), bounds(body), axis) || restitution_of(scene, body) > 0)
            return std::nullopt;
        const bool forwards = body.velocity[axis] > 0;
        const Span own(bounds(body), axis, forwards), ahead(bounds(*wall), axis, forwards);
        const double own_way = 0.5 * (ahead.far - ahead.near + own.far - own.near);
        if (own.far > ahead.near || (way && std::abs(*way - own_way) > 1e-9 * own_way))
            return std::nullopt;
        way = own_way;
    }
    return way;
}

std::optional<double> column_of_cubes(const SceneDesc &scene, const std::string &cube) {
    if (!scene.joints.empty() || !scene.particles.empty() || !scene.cloths.empty() ||
        !scene.attractors.empty())
        return std::nullopt;
    std::optional<double> side;
    double height = 0;
    for (const BodyDesc &body : scene.bodies) {
        if (body.kind == BodyKind::static_body && has_plane(body))
            continue;
        const auto *box = std::get_if<BoxDesc>(&body.colliders.front().shape);
        if (box == nullptr || body.colliders.size() != 1 || body.kind != BodyKind::dynamic ||
            (body.name != cube && !body.name.starts_with(cube + "_")))
            return std::nullopt;
        const double own = 2 * box->half_extents.x;
        if (box->half_extents != glm::dvec3(own / 2) || own != side.value_or(own) ||
            std::abs(body.position.y - (height + own / 2)) > 1e-6 * own ||
            !in_line(body.position, scene.bodies.back().position, 1))
            return std::nullopt;
        side = own;
        height += own;
    }
    return side;
}

std::optional<double> highest_column(const ResolvedRun &run, double side) {
    const StepSettings &settings = run.settings;
    const bool is_whole = run.method->name == "soft_step";
    if (!is_whole && run.method->name != "tgs_soft")
        return std::nullopt;
    if (is_whole && (settings.max_substeps > settings.substeps || settings.sleep_after > 0 ||
                     settings.kept_travel > 0))
        return std::nullopt;
    constexpr double greenhill = 7.837347; // 9/4 of the square of the first root of J_-1/3
    const double w =
        2 * std::numbers::pi * settings.contact_frequency_ratio * settings.substeps / settings.dt;
    return std::cbrt(greenhill * (is_whole ? 1 : 0.5) * w * w * side /
                     (4 * std::abs(settings.gravity.y)));
}

bool swings_by_itself(const SceneDesc &scene, const std::string &spring) {
    return lone_oscillator(scene, spring).has_value() && scene.springs.front().damping == 0;
}

std::optional<Oscillator> lone_oscillator(const SceneDesc &scene, const std::string &spring) {
    if (scene.springs.size() != 1 || !scene.cloths.empty() || !scene.joints.empty())
        return std::nullopt;
    const SpringDesc &only = scene.springs.front();
    if (only.name != spring || only.a.empty() == only.b.empty())
        return std::nullopt;
    const auto particle =
        std::ranges::find(scene.particles, only.a.empty() ? only.b : only.a, &ParticleDesc::name);
    if (particle == scene.particles.end() || particle->pinned)
        return Oscillator{};
    return Oscillator{std::sqrt(only.stiffness / particle->mass), particle->mass};
}

namespace {

// Velocity Verlet in its first substep, with u = omega h and s = rate h / 2: the first half kick's
// damping scales the velocity by p = 1 - s, and the second's, evaluated after one correction, by
// q = 1 - s + s^2. In (x, h v) the substep is
//   [ 1 - u^2/2                             p                ]
//   [ -q u^2/2 - p (1 - u^2/2) u^2/2    q p - p^2 u^2/2 ]
// with determinant p q and trace 1 - u^2/2 + p q - p^2 u^2/2. Of Jury's conditions the one on
// -trace fails first: u^2 (1 + p^2) = 4 (1 + p q), which has one root.
double longest_verlet_step(double omega, double rate) {
    const auto is_stable = [&](double h) {
        const double u = omega * h, s = 0.5 * rate * h;
        const double p = 1 - s, q = 1 - s + s * s;
        return u * u * (1 + p * p) <= 4 * (1 + p * q);
    };
    double low = 0, high = 4 / omega;
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (is_stable(middle) ? low : high) = middle;
    }
    return low;
}

} // namespace

std::optional<double> longest_damped_step(std::string_view method, double omega, double rate) {
    if (method == "velocity_verlet")
        return longest_verlet_step(omega, rate);
    if (method == "explicit_euler" && rate < 2 * omega)
        return rate / (omega * omega); // |1 + h lambda|^2 = 1 - h rate + h^2 omega^2
    if (method == "semi_implicit_euler")
        return 4 / (std::sqrt(rate * rate + 4 * omega * omega) + rate);
    if (rate < 2 * omega)
        return std::nullopt;
    const double fastest = 0.5 * (rate + std::sqrt(rate * rate - 4 * omega * omega));
    if (method == "explicit_euler")
        return 2 / fastest;
    if (method == "stormer_verlet")
        return 2 / rate;
    constexpr double rk4 = 2.785293563405282; // 1 - z + z^2/2 - z^3/6 + z^4/24 = 1
    if (method == "rk4")
        return rk4 / fastest;
    return std::nullopt;
}

bool grows_by_theory(const SceneDesc &scene, const ResolvedRun &run) {
    if (run.method->name != "explicit_euler" || scene.springs.size() != 1 ||
        scene.springs.front().tear_strain > 0 || !scene.attractors.empty())
        return false;
    const SpringDesc &spring = scene.springs.front();
    const std::optional<Oscillator> swing = lone_oscillator(scene, spring.name);
    if (!swing)
        return false;
    if (swing->mass > 0) {
        const std::optional<double> longest =
            longest_damped_step(run.method->name, swing->omega, spring.damping / swing->mass);
        return longest && run.settings.dt / run.settings.substeps > *longest;
    }
    const auto held =
        std::ranges::find(scene.bodies, spring.a.empty() ? spring.b : spring.a, &BodyDesc::name);
    return held != scene.bodies.end() && held->kind == BodyKind::dynamic && spring.damping == 0 &&
           held->linear_damping == 0 && held->angular_damping == 0 &&
           std::ranges::none_of(held->locked, [](bool locked) { return locked; });
}

namespace {

struct DtAxis {
    bool along_x = false;
    const MapAxis &dt, &other;

    [[nodiscard]] glm::dvec2 point(double dt_value, double value) const {
        return along_x ? glm::dvec2(dt_value, value) : glm::dvec2(value, dt_value);
    }
    // The other axis's value for each dt.
    template <typename Of> [[nodiscard]] std::vector<glm::dvec2> curve(const Of &value) const {
        std::vector<glm::dvec2> points;
        // Past both ends, to cover the outer halves of the outermost cells.
        const double low = 0.5 * dt.values.front(), high = 2 * dt.values.back();
        for (int i = 0; i <= curve_points; ++i) {
            const double at = low * std::pow(high / low, static_cast<double>(i) / curve_points);
            points.push_back(point(at, value(at)));
        }
        return points;
    }
};

// "coil" for an axis "spring.coil.TAIL".
std::optional<std::string> spring_of(const MapAxis &axis, std::string_view tail) {
    const std::string_view name = axis.name, head = "spring.";
    if (!name.starts_with(head) || !name.ends_with(tail) ||
        name.size() <= head.size() + tail.size())
        return std::nullopt;
    return std::string(name.substr(head.size(), name.size() - head.size() - tail.size()));
}

int substeps_of(const StabilityMap &map, const MethodInfo &method, const RunOptions &base) {
    RunOptions run = base;
    run.method = std::string(method.name);
    return resolve_run(map.scene, run).settings.substeps;
}

void add_thrown(std::vector<TheoryCurve> &curves, const StabilityMap &map, const DtAxis &axes) {
    const std::optional<FlownAxis> flown = flown_axis(axes.other);
    if (!flown)
        return;
    const std::optional<double> way = way_into_wall(map.scene, flown->body, flown->axis);
    if (!way)
        return;
    TheoryCurve curve;
    curve.name = "theory: v dt = (thickness + size) / 2, past the wall's middle unseen";
    for (const MethodMap &of_method : map.methods)
        if (waits_for_overlap(*of_method.method))
            curve.methods.push_back(of_method.method);
    if (curve.methods.empty())
        return;
    curve.points = axes.curve([&](double dt) { return *way / dt; });
    curves.push_back(std::move(curve));
}

void add_damped_spring(std::vector<TheoryCurve> &curves, const StabilityMap &map,
                       const DtAxis &axes, const RunOptions &base) {
    const std::optional<std::string> name = spring_of(axes.other, ".damping");
    const std::optional<Oscillator> swing = name ? lone_oscillator(map.scene, *name) : std::nullopt;
    if (!swing || !(swing->mass > 0))
        return;
    for (const MethodMap &of_method : map.methods) {
        const int substeps = substeps_of(map, *of_method.method, base);
        // Its later substeps start with the acceleration from the end of the previous one.
        if (of_method.method->name == "velocity_verlet" && substeps > 1)
            continue;
        TheoryCurve curve;
        const double low = axes.other.values.front(), high = axes.other.values.back();
        for (int i = 0; i <= curve_points; ++i) {
            const double share = static_cast<double>(i) / curve_points;
            // Past both ends, to cover the outer halves of the outermost cells.
            const double damping =
                low > 0 ? 0.5 * low * std::pow(4 * high / low, share) : 1.5 * high * share;
            if (const std::optional<double> h = longest_damped_step(
                    of_method.method->name, swing->omega, damping / swing->mass))
                curve.points.push_back(axes.point(substeps * *h, damping));
        }
        if (curve.points.empty())
            continue;
        const std::string_view method = of_method.method->name;
        curve.name = "theory: ";
        if (substeps > 1)
            curve.name += std::to_string(substeps) + " × ";
        curve.name += method == "rk4"                   ? "2.785 / λ"
                      : method == "stormer_verlet"      ? "2 m / c"
                      : method == "velocity_verlet"     ? "(ω h)² (1 + p²) = 4 (1 + p q)"
                      : method == "semi_implicit_euler" ? "4 / (√(c² / m² + 4 ω²) + c / m)"
                                                        : "2 / λ, or c / k if underdamped";
        curve.name.append(" (").append(method).append(")");
        curve.methods = {of_method.method};
        curves.push_back(std::move(curve));
    }
}

// For an axis "body.box.repeat.count".
void add_column(std::vector<TheoryCurve> &curves, const StabilityMap &map, const DtAxis &axes,
                const RunOptions &base) {
    constexpr std::string_view head = "body.", tail = ".repeat.count";
    const std::string &name = axes.other.name;
    if (!name.starts_with(head) || !name.ends_with(tail))
        return;
    const std::optional<double> side = column_of_cubes(
        map.scene, name.substr(head.size(), name.size() - head.size() - tail.size()));
    for (const MethodMap &of_method : map.methods) {
        RunOptions options = base;
        options.method = std::string(of_method.method->name);
        ResolvedRun run = resolve_run(map.scene, options);
        if (!side || !highest_column(run, *side))
            continue;
        const std::string label =
            "theory: N³ = 7.84 k s / (4 m g) (" + std::string(of_method.method->name) + ")";
        curves.push_back({label, {of_method.method}, axes.curve([&](double dt) {
                              run.settings.dt = dt;
                              return *highest_column(run, *side);
                          })});
    }
}

void add_struck(std::vector<TheoryCurve> &curves, const StabilityMap &map, const DtAxis &axes) {
    const std::optional<FlownAxis> flown = flown_axis(axes.other);
    if (!flown)
        return;
    const std::optional<StruckBody> struck =
        struck_before_wall(map.scene, flown->body, flown->axis);
    if (!struck)
        return;
    TheoryCurve curve;
    curve.name = "theory: knocked to the wall's middle in one step";
    for (const MethodMap &of_method : map.methods)
        if (of_method.method->contacts && !of_method.method->looks_ahead &&
            !waits_for_overlap(*of_method.method))
            curve.methods.push_back(of_method.method);
    if (curve.methods.empty())
        return;
    curve.points = axes.curve([&](double dt) { return struck->way / (struck->speed_ratio * dt); });
    curves.push_back(std::move(curve));
}

void add_spring(std::vector<TheoryCurve> &curves, const StabilityMap &map, const DtAxis &axes,
                const RunOptions &base) {
    const std::optional<std::string> by_frequency = spring_of(axes.other, ".frequency");
    const std::optional<std::string> name =
        by_frequency ? by_frequency : spring_of(axes.other, ".stiffness");
    if (!name || !swings_by_itself(map.scene, *name))
        return;
    const double mass = lone_oscillator(map.scene, *name)->mass;
    if (!by_frequency && !(mass > 0))
        return; // the spring holds a body, perhaps off its centre
    for (const MethodMap &of_method : map.methods)
        if (of_method.method->name == "explicit_euler")
            curves.push_back(
                {"theory: unstable at any dt (explicit_euler)", {of_method.method}, {}});
    // Methods with the same limit and number of substeps share a curve.
    for (const SpringLimit &limit : spring_limits) {
        std::map<int, std::vector<const MethodInfo *>> by_substeps;
        for (const MethodMap &of_method : map.methods) {
            if (std::ranges::find(limit.methods, of_method.method->name) == limit.methods.end())
                continue;
            by_substeps[substeps_of(map, *of_method.method, base)].push_back(of_method.method);
        }
        for (const auto &[substeps, methods] : by_substeps) {
            std::string label = "theory: ω dt = ";
            if (substeps > 1)
                label += std::to_string(substeps) + " × ";
            label += limit.text;
            for (const MethodInfo *method : methods)
                label.append(method == methods.front() ? " (" : ", ").append(method->name);
            const double omega_dt = limit.omega_h * substeps;
            curves.push_back({label + ")", methods, axes.curve([&](double dt) {
                                  const double omega = omega_dt / dt;
                                  return by_frequency ? omega / (2 * std::numbers::pi)
                                                      : mass * omega * omega;
                              })});
        }
    }
}

} // namespace

std::vector<TheoryCurve> theory_of(const StabilityMap &map, const RunOptions &base) {
    const auto is_dt = [](const MapAxis &axis) { return axis.name == "dt"; };
    if (is_dt(map.x) == is_dt(map.y))
        return {};
    const DtAxis axes{is_dt(map.x), is_dt(map.x) ? map.x : map.y, is_dt(map.x) ? map.y : map.x};
    std::vector<TheoryCurve> curves;
    add_struck(curves, map, axes);
    add_thrown(curves, map, axes);
    add_spring(curves, map, axes, base);
    add_damped_spring(curves, map, axes, base);
    add_column(curves, map, axes, base);
    return curves;
}

} // namespace plumb
