// One shape: its mesh vertex, pose and size.
layout(location = 0) in vec3 mesh_position;
layout(location = 1) in vec3 mesh_normal;
layout(location = 2) in float mesh_end;
layout(location = 3) in vec4 instance_position; // w: a capsule's or cylinder's half height
layout(location = 4) in vec4 instance_rotation;
layout(location = 5) in vec4 instance_scale;  // w: 0 sphere, 1 box, 2 capsule, 3 cylinder, 4 triangles
layout(location = 6) in vec4 instance_colour; // linear; w: highlighted

vec3 rotate(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

// `grow` metres larger on every side.
vec3 local_position(float grow) {
    return mesh_position * (instance_scale.xyz + grow) +
           vec3(0.0, mesh_end * instance_position.w, 0.0);
}
