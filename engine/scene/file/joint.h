// The table of a joint in a scene file. Not for users of the engine.
#pragma once

#include "engine/scene/file/table.h"
#include "engine/scene/joint_type.h"

namespace plumb::scene_file {

// What a joint's table says of one joint or, in a chain, of each.
struct JointTable {
    const Table &table;
    const JointTypeInfo &type;
    JointDesc joint; // without bodies, anchors and frames
    bool has_length = false;
    glm::dquat frame{1, 0, 0, 0}; // of both bodies, world
};

Words joint_keys_in_files(); // all that a joint may have, of whatever type

// Null, having reported it, when there is no usable one.
const JointTypeInfo *read_joint_type(const Table &table);

// The keys of the table of joint types, and the remembered impulses. Reports every error, and keys
// that only other types have.
void read_joint_values(Report &report, JointTable &source);

} // namespace plumb::scene_file
