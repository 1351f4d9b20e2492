#include "engine/scene/expect.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/shape_write.h"
#include "engine/scene/file/text.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/shape_kinds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

namespace plumb {

namespace {

using namespace scene_file;

// A multi-line string if it has several lines.
std::string paragraph(std::string_view value) {
    if (value.find('\n') == std::string_view::npos)
        return string(value);
    std::string text = "\"\"\"\n";
    for (const char c : value)
        if (c == '\n')
            text += c;
        else
            append_escaped(text, c);
    return text + "\"\"\"";
}

std::string bare_or_quoted_key(const std::string &key) {
    const bool is_bare =
        !key.empty() && key.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                              "0123456789_-") == std::string::npos;
    return is_bare ? key : string(key);
}

std::string natural(std::uint64_t value) {
    const std::string digits = std::to_string(value);
    const bool fits = value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    return fits ? digits : '"' + digits + '"';
}

class SceneWriter {
  public:
    std::string write(const SceneDesc &scene) {
        if (!scene.title.empty())
            line("title", string(scene.title));
        if (!scene.description.empty())
            line("description", paragraph(scene.description));
        write_world(scene.world);
        write_camera(scene.camera);
        for (const MaterialDesc &material : scene.materials)
            write_material(material);
        for (const BodyDesc &body : scene.bodies)
            write_body(body);
        for (const JointDesc &joint : scene.joints)
            header("[[joint]]"), text_ += joint_text(joint);
        for (const AttractorDesc &attractor : scene.attractors)
            header("[[attractor]]"), text_ += attractor_text(attractor);
        for (const ParticleDesc &particle : scene.particles)
            header("[[particle]]"), text_ += particle_text(particle);
        for (const ClothDesc &cloth : scene.cloths)
            header("[[cloth]]"), text_ += cloth_text(cloth);
        for (const SpringDesc &spring : scene.springs)
            header("[[spring]]"), text_ += spring_text(spring);
        for (const ProbeDesc &probe : scene.probes)
            write_probe(probe);
        for (const ExpectDesc &expect : scene.expects)
            write_expect(expect);
        write_state(scene);
        return std::move(text_);
    }
    std::string body_text(const BodyDesc &body) {
        write_body_lines(body);
        return std::move(text_);
    }
    std::string settings_text(const GivenSettings &given) {
        write_settings(given);
        return std::move(text_);
    }

  private:
    void header(const std::string &brackets) {
        text_ += (text_.empty() ? "" : "\n") + brackets + "\n";
    }
    void line(const std::string &key, const std::string &value) {
        text_ += key + " = " + value + "\n";
    }

    void write_settings(const GivenSettings &given) {
        const StepSettings settings = given.applied();
        for (const SettingRow &row : setting_rows) {
            if (!given.has(row))
                continue;
            const std::string value = setting_text(row, settings);
            const bool is_fraction = value.find('/') != std::string::npos;
            line(std::string(row.name), is_vector(row) ? '[' + value + ']'
                                        : is_fraction  ? '"' + value + '"'
                                                       : value);
        }
    }

    void write_world(const WorldDesc &world) {
        header("[world]");
        line("method", string(world.method));
        write_settings(world.settings);
        line("precision", world.precision == Precision::f32 ? "\"float\"" : "\"double\"");
        line("seed", natural(world.seed));
        for (const auto &[method, settings] : world.other_methods) {
            header("[methods." + bare_or_quoted_key(method) + "]");
            write_settings(settings);
        }
    }

    void write_camera(const CameraDesc &camera) {
        header("[camera]");
        line("target", array3(camera.target));
        line("distance", shortest(camera.distance));
        text_ += angle("yaw", camera.yaw);
        text_ += angle("pitch", camera.pitch);
        text_ += angle("fov", camera.fov);
    }

    void write_material(const MaterialDesc &material) {
        header("[[material]]");
        line("name", string(material.name));
        line("density", shortest(material.density));
        line("friction", shortest(material.friction));
        line("restitution", shortest(material.restitution));
        if (material.colour)
            line("color", array3(*material.colour));
    }

    void lines(const std::vector<std::string> &fields) {
        for (const std::string &field : fields)
            text_ += field + "\n";
    }

    // Whether a body's only shape has no placement, material or density of its own.
    static bool is_plain(const ColliderDesc &collider) {
        return same_bits(collider.position, {0, 0, 0}) && is_identity(collider.orientation) &&
               collider.material.empty() && !collider.density;
    }
    static bool is_identity(const glm::dquat &q) {
        return same_bits(q.w, 1) && same_bits({q.x, q.y, q.z}, {0, 0, 0});
    }

    void write_shapes(const BodyDesc &body) {
        if (body.colliders.size() == 1 && is_plain(body.colliders.front())) {
            lines(shape_fields(body.colliders.front().shape));
            return;
        }
        text_ += "shapes = [\n";
        for (const ColliderDesc &collider : body.colliders)
            text_ += "    " + collider_text(collider) + ",\n";
        text_ += "]\n";
    }

    void write_mass(const BodyDesc &body) {
        if (!body.material.empty())
            line("material", string(body.material));
        if (body.mass)
            line("mass", shortest(*body.mass));
        if (body.density)
            line("density", shortest(*body.density));
        if (body.center_of_mass)
            line("center_of_mass", array3(*body.center_of_mass));
        if (body.inertia)
            line("inertia", array3(*body.inertia));
        if (body.mass_pose)
            line("mass_pose", "{ position = " + array3(body.mass_pose->position) +
                                  ", orientation = " + rotation(body.mass_pose->orientation) +
                                  " }");
    }

    void write_pace(const BodyDesc &body) {
        const BodyDesc::Pace &pace = body.pace;
        if (pace.substeps > 0 || pace.wanted > 0 || pace.rested > 0 || pace.struck > 0)
            line("pace", "{ substeps = " + std::to_string(pace.substeps) +
                             ", wanted = " + std::to_string(pace.wanted) +
                             ", rested = " + std::to_string(pace.rested) +
                             ", struck = " + std::to_string(pace.struck) + " }");
    }

    void write_freedom(const BodyDesc &body) {
        std::string locked;
        for (std::size_t axis = 0; axis < body.locked.size(); ++axis)
            if (body.locked[axis])
                locked += (locked.empty() ? "" : ", ") + string(locked_names[axis]);
        if (!locked.empty())
            line("locked", "[" + locked + "]");
        if (!same_bits(body.gravity_scale, 1))
            line("gravity_scale", shortest(body.gravity_scale));
        if (!same_bits(body.force, {0, 0, 0}))
            line("force", array3(body.force));
        if (!same_bits(body.torque, {0, 0, 0}))
            line("torque", array3(body.torque));
        if (!same_bits(body.linear_damping, 0))
            line("linear_damping", shortest(body.linear_damping));
        if (!same_bits(body.angular_damping, 0))
            line("angular_damping", shortest(body.angular_damping));
    }

    void write_body(const BodyDesc &body) {
        header("[[body]]");
        write_body_lines(body);
    }

    void write_body_lines(const BodyDesc &body) {
        constexpr std::array<const char *, 3> kinds{"\"static\"", "\"kinematic\"", "\"dynamic\""};
        const bool can_be_dynamic =
            std::ranges::all_of(body.colliders, [](const ColliderDesc &collider) {
                return kind_info(collider.shape).moves == Moves::by_forces;
            });
        line("name", string(body.name));
        if (body.kind != (can_be_dynamic ? BodyKind::dynamic : BodyKind::static_body))
            line("kind", kinds[static_cast<std::size_t>(body.kind)]);
        write_shapes(body);
        write_mass(body);
        write_pace(body);
        if (body.colliders.size() == 1 && is_plain(body.colliders.front()))
            lines(filter_fields(body.colliders.front()));
        line("position", array3(body.position));
        if (!is_identity(body.orientation))
            line("orientation", rotation(body.orientation));
        if (!same_bits(body.velocity, {0, 0, 0}))
            line("velocity", array3(body.velocity));
        if (!same_bits(body.angular_velocity, {0, 0, 0}))
            line("angular_velocity", array3(body.angular_velocity));
        write_freedom(body);
        if (body.colour)
            line("color", array3(*body.colour));
    }

    static std::string probe_camera(const ProbeCameraDesc &camera) {
        std::string text =
            "{ eye = " + array3(camera.eye) + ", target = " + array3(camera.target) + ", ";
        text += angle_in_line("fov", camera.fov);
        if (camera.height)
            text += ", height = " + shortest(*camera.height);
        text += ", aspect = " + shortest(camera.aspect) + ", near = " + shortest(camera.near) +
                ", far = " + shortest(camera.far);
        if (camera.pixel)
            text +=
                ", pixel = [" + shortest(camera.pixel->x) + ", " + shortest(camera.pixel->y) + "]";
        return text + " }";
    }

    void write_probe(const ProbeDesc &probe) {
        constexpr std::array<const char *, 3> trees{"\"quadtree\"", "\"octree\"", "\"bvh\""};
        const ProbeQuestionInfo &info = probe_question(probe.question);
        const bool flat = is_flat(probe);
        header("[[probe]]");
        line("name", string(probe.name));
        line("ask", string(info.name));
        if (!probe.shapes.empty()) {
            text_ += "shapes = [\n";
            for (const ProbeShapeDesc &shape : probe.shapes)
                text_ += "    " + probe_shape_text(shape) + ",\n";
            text_ += "]\n";
        }
        if (!probe.points.empty())
            line("points", places_text(probe.points, flat));
        if (probe.ray && probe.ray->end)
            line("segment", places_text({probe.ray->origin, *probe.ray->end}, flat));
        else if (probe.ray)
            line("ray", "{ origin = " + place_text(probe.ray->origin, flat) +
                            ", direction = " + place_text(probe.ray->direction, flat) +
                            (probe.ray->max_t ? ", max_t = " + shortest(*probe.ray->max_t) : "") +
                            " }");
        if (probe.camera)
            line("camera", probe_camera(*probe.camera));
        if (probe.scatter)
            line("scatter",
                 "{ count = " + std::to_string(probe.scatter->count) +
                     ", center = " + place_text(probe.scatter->center, flat) +
                     ", half_extents = " + place_text(probe.scatter->half_extents, flat) +
                     ", size = " + shortest(probe.scatter->size) +
                     ", seed = " + natural(probe.scatter->seed) + " }");
        if (probe.tree)
            line("tree", trees[static_cast<std::size_t>(*probe.tree)]);
        if (info.does_take("level"))
            line("level", std::to_string(probe.level));
        if (info.does_take("margin"))
            line("margin", shortest(probe.margin));
        if (info.does_take("motion"))
            line("motion", array3(probe.motion));
        if (info.does_take("scale"))
            line("scale", array3(probe.scale));
        if (probe.source.empty())
            return;
        std::string expected;
        for (const ProbeExpectDesc &expect : probe.expects)
            expected +=
                (expected.empty() ? " " : ", ") + expect.value + " = " + shortest(expect.is);
        line("expect", "{" + expected + " }");
        line("tolerance", shortest(probe.tolerance));
        line("source", string(probe.source));
    }

    void write_expect(const ExpectDesc &expect) {
        constexpr std::array<const char *, 3> relations{"equals", "at_most", "at_least"};
        header("[[expect]]");
        line("name", string(expect.name));
        line("quantity", string(expect.quantity));
        if (!expect.body.empty())
            line(std::string(find_quantity(expect.quantity)->subject()), string(expect.body));
        line("reduce", string(expect.reduce));
        if (expect.level)
            line("level", shortest(*expect.level));
        line("from", shortest(expect.from));
        line("to", shortest(expect.to));
        line(relations[static_cast<std::size_t>(expect.relation)],
             expect.curve.empty() ? shortest(expect.value) : array_of(expect.curve));
        if (expect.relation == ExpectDesc::Relation::equals)
            line("tolerance", shortest(expect.tolerance));
        if (expect.estimate)
            line("estimate", shortest(*expect.estimate));
        line("source", string(expect.source));
    }

    void write_grab(const GrabStateDesc &grab) {
        header("[state.grab]");
        if (!grab.body.empty()) {
            line("body", string(grab.body));
            line("point", array3(grab.point_local));
            line("impulse", array3(grab.impulse));
        } else {
            line("particle", string(grab.particle));
            line("held_mass", shortest(grab.held_mass));
        }
        line("target", array3(grab.target));
        line("max_force", shortest(grab.max_force));
        line("frequency", shortest(grab.frequency));
        line("damping_ratio", shortest(grab.damping_ratio));
    }

    void write_state(const SceneDesc &scene) {
        if (scene.step_count == 0 && scene.contacts.empty() && !scene.grab)
            return;
        header("[state]");
        line("step", natural(scene.step_count));
        if (scene.dt_since_step > 0) {
            line("dt_since_step", natural(scene.dt_since_step));
            line("dt_since_time", shortest(scene.dt_since_time));
        }
        if (scene.grab)
            write_grab(*scene.grab);
        for (const ContactStateDesc &contact : scene.contacts) {
            std::string features;
            std::string impulses;
            std::string cores_a;
            std::string cores_b;
            std::string penalties;
            bool has_penalties = false;
            for (const ContactStateDesc::Point &point : contact.points) {
                features += (features.empty() ? "" : ", ") + std::to_string(point.feature);
                impulses += (impulses.empty() ? "" : ", ") + array3(point.impulse);
                cores_a += (cores_a.empty() ? "" : ", ") + array3(point.core_a);
                cores_b += (cores_b.empty() ? "" : ", ") + array3(point.core_b);
                std::string penalty;
                for (const double value : point.penalty) {
                    penalty += (penalty.empty() ? "[" : ", ") + shortest(value);
                    has_penalties = has_penalties || !same_bits(value, 0);
                }
                penalties += (penalties.empty() ? "" : ", ") + penalty + "]";
            }
            header("[[state.contact]]");
            line("body_a", string(contact.body_a));
            line("body_b", string(contact.body_b));
            if (contact.child_a != 0)
                line("child_a", natural(contact.child_a));
            if (contact.child_b != 0)
                line("child_b", natural(contact.child_b));
            if (contact.triangle)
                line("triangle", natural(*contact.triangle));
            line("features", "[" + features + "]");
            line("impulses", "[" + impulses + "]");
            line("cores_a", "[" + cores_a + "]");
            line("cores_b", "[" + cores_b + "]");
            if (has_penalties)
                line("penalties", "[" + penalties + "]");
            line("normal", array3(contact.normal));
            line("offset", array3(contact.offset));
            line("rotation_a", rotation(contact.rotation_a));
            line("rotation_b", rotation(contact.rotation_b));
        }
    }

    std::string text_;
};

} // namespace

std::string scene_file::body_text(const BodyDesc &body) {
    return SceneWriter().body_text(body);
}
std::string scene_file::settings_text(const GivenSettings &given) {
    return SceneWriter().settings_text(given);
}

std::string write_scene(const SceneDesc &scene) {
    return SceneWriter().write(scene);
}

} // namespace plumb
