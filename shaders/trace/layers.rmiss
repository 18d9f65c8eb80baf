// The batch that the any-hit shader collected is the result: nothing to add.
#version 460
#extension GL_EXT_ray_tracing : require

void main() {}
