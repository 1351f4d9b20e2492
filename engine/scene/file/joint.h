// A joint's table in a scene file. Not for users of the engine.
#pragma once

#include "engine/scene/file/table.h"
#include "engine/scene/joint_type.h"

namespace plumb::scene_file {

// What a joint's table specifies for one joint or, in a chain, for each.
struct JointTable {
    const Table &table;
    const JointTypeInfo &type;
    JointDesc joint; // without bodies, anchors and frames
    bool has_length = false;
    glm::dquat frame{1, 0, 0, 0}; // of both bodies, world
};

Words joint_keys_in_files(); // the keys of all joint types

// Null, with an error reported, when there is no usable type.
const JointTypeInfo *read_joint_type(const Table &table);

// Reads the keys listed in the joint type table, and the saved impulses. Reports every error,
// including keys that only other types have.
void read_joint_values(Report &report, JointTable &source);

} // namespace plumb::scene_file
