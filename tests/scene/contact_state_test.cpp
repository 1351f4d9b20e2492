// Contacts stored in a scene file.
#include "engine/math/basis.h"
#include "engine/scene/simulation.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

// A contact's force on its second body, from its impulses along the normal and both tangents.
Vec3 on_second(const ContactStateDesc &contact, const glm::dvec3 &impulse) {
    const Vec3 n{contact.normal};
    const TangentBasis tangents = tangent_basis(n);
    const Vec3 i{impulse};
    return i.x * n + i.y * tangents.t1 + i.z * tangents.t2;
}

// The same contact seen from the other body.
ContactStateDesc from_the_other_side(ContactStateDesc contact) {
    std::swap(contact.body_a, contact.body_b);
    std::swap(contact.child_a, contact.child_b);
    std::swap(contact.rotation_a, contact.rotation_b);
    contact.offset = -contact.offset;
    const ContactStateDesc before = contact;
    contact.normal = -contact.normal;
    const TangentBasis tangents = tangent_basis(Vec3{contact.normal});
    for (ContactStateDesc::Point &point : contact.points) {
        std::swap(point.core_a, point.core_b);
        const Vec3 force = -on_second(before, point.impulse);
        point.impulse = {point.impulse.x, glm::dot(force, tangents.t1),
                         glm::dot(force, tangents.t2)};
    }
    return contact;
}

// A box that friction holds under oblique gravity, so that its contact carries load along both
// tangents.
SceneDesc resting_box() {
    SceneDesc scene;
    scene.world.settings.give(&StepSettings::gravity, {1, -9, 2});
    for (const bool is_floor : {true, false}) {
        BodyDesc body;
        body.name = is_floor ? "floor" : "box";
        body.kind = is_floor ? BodyKind::static_body : BodyKind::dynamic;
        body.colliders.emplace_back().shape =
            BoxDesc{is_floor ? glm::dvec3{5, 0.5, 5} : glm::dvec3{0.5, 0.2, 0.4}};
        body.position = {0, is_floor ? -0.5 : 0.2, 0};
        scene.bodies.push_back(body);
    }
    const auto simulation = Simulation::create(scene, {}, nullptr);
    for (int i = 0; i < 60; ++i)
        simulation->step();
    return simulation->describe();
}

TEST(ContactState, IsTheSameFromEitherBody) {
    const SceneDesc scene = resting_box();
    ASSERT_EQ(scene.contacts.size(), 1u);
    ASSERT_GT(std::abs(scene.contacts[0].points[0].impulse.y), 1e-3);
    ASSERT_GT(std::abs(scene.contacts[0].points[0].impulse.z), 1e-3);
    SceneDesc other = scene;
    other.contacts[0] = from_the_other_side(other.contacts[0]);
    const SceneDesc back = Simulation::create(other, {}, nullptr)->describe();
    ASSERT_EQ(back.contacts.size(), 1u);
    const ContactStateDesc &is = back.contacts[0];
    const ContactStateDesc &was = scene.contacts[0];
    EXPECT_EQ(is.body_a, was.body_a);
    EXPECT_EQ(is.body_b, was.body_b);
    EXPECT_EQ(is.normal, was.normal);
    EXPECT_EQ(is.offset, was.offset);
    ASSERT_EQ(is.points.size(), was.points.size());
    for (std::size_t i = 0; i < is.points.size(); ++i) {
        EXPECT_EQ(is.points[i].core_a, was.points[i].core_a);
        EXPECT_EQ(is.points[i].core_b, was.points[i].core_b);
        EXPECT_LT(glm::distance(is.points[i].impulse, was.points[i].impulse),
                  1e-6 * glm::length(was.points[i].impulse));
    }
}

} // namespace
} // namespace plumb
