#include "app/lab/engines/other_engines.h"

#include <algorithm>
#include <stdexcept>

namespace plumb {

namespace {

#if defined(PLUMB_WITH_BULLET) || defined(PLUMB_WITH_ODE)
OtherEngine engine(const char *name, const char *title, const char *source, Precision precision,
                   int iterations, std::unique_ptr<Engine> (*create)(const EngineScene &)) {
    OtherEngine other;
    other.info.name = name;
    other.info.title = title;
    other.info.source = source;
    other.info.contacts = other.info.joints = true;
    other.info.reads = {SettingGroup::constraints};
    other.info.defaults = {.substeps = 1, .iterations = iterations};
    other.precision = precision; // as Debian builds it
    other.create = create;
    return other;
}
#endif

std::vector<OtherEngine> built() {
    std::vector<OtherEngine> all;
#ifdef PLUMB_WITH_BULLET
    all.push_back(
        engine("bullet", "Bullet", "Bullet 3 (Coumans)", Precision::f32, 10, bullet_engine));
#endif
#ifdef PLUMB_WITH_ODE
    all.push_back(
        engine("ode", "ODE", "Open Dynamics Engine (Smith)", Precision::f64, 20, ode_engine));
#endif
    return all;
}

std::string no_such_engine(const std::string &name) {
    if (other_engines().empty())
        return "this build has no other engines: `./plumb bench` installs and builds them "
               "(-DPLUMB_BENCH=ON)";
    std::string known;
    for (const OtherEngine &other : other_engines())
        known.append(known.empty() ? "" : ", ").append(other.info.name);
    return "there is no engine \"" + name + "\"; this build has " + known;
}

} // namespace

std::span<const OtherEngine> other_engines() {
    static const std::vector<OtherEngine> all = built();
    return all;
}

std::vector<const OtherEngine *> find_other_engines(const std::vector<std::string> &names) {
    std::vector<const OtherEngine *> found;
    for (const std::string &name : names) {
        const auto engine = std::ranges::find(
            other_engines(), name, [](const OtherEngine &other) { return other.info.name; });
        if (engine == other_engines().end())
            throw std::invalid_argument(no_such_engine(name));
        if (std::ranges::find(found, &*engine) == found.end())
            found.push_back(&*engine);
    }
    return found;
}

const MethodInfo *find_charted(std::string_view name) {
    for (const OtherEngine &other : other_engines())
        if (other.info.name == name)
            return &other.info;
    return find_method_info(name);
}

std::string why_not(const OtherEngine &engine, const SceneDesc &scene) {
    std::string what = beyond_engines(scene);
    if (what.empty())
        try {
            const EngineScene told(scene);
            if (engine.create(told))
                return "";
            what = "one of its shapes or joints";
        } catch (const std::invalid_argument &refusal) {
            what = refusal.what();
        }
    return std::string(engine.info.name) + " cannot run this scene: the adapter does not support " +
           what;
}

ResolvedRun resolve_run(const OtherEngine &engine, const SceneDesc &scene,
                        const GivenSettings &given) {
    ResolvedRun run{&engine.info, settings_of(scene.world, engine.info), engine.precision};
    given.apply_to(run.settings);
    return run;
}

} // namespace plumb
