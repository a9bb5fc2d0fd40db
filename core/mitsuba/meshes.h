// Mesh files of Mitsuba scenes, in object space, with the parameters that alter them.
#pragma once

#include "core/mitsuba/state.h"
#include "core/obj.h"

#include <vector>

namespace lockstep::mitsuba {

// Whether shapes of this (plain) type are read from a file.
bool is_mesh_file(const std::string& type);

// The mesh of an obj, ply or serialized shape. As Mitsuba does, smooth normals are made where the
// file has none, unless "face_normals"; "max_smooth_angle" keeps them from crossing sharper edges.
// One that was read ahead is handed out, or its error thrown, here.
TriangleMesh read_mesh_file(State& state, const Properties& set);

// Reads the mesh files of these shapes, several at a time, for read_mesh_file() to hand out. Errors
// wait for it, too: the first in the file is the one that is reported.
void read_meshes_ahead(State& state, const std::vector<Element>& shapes);

// An obj shape by material, for files that bring their own.
ObjFile read_obj_file(State& state, const Properties& set);

// Turns a mesh to the side that its normals are on; those decide in Mitsuba.
void agree_with_normals(TriangleMesh& mesh);

void turn_over(TriangleMesh& mesh);

}  // namespace lockstep::mitsuba
