// How the functions behind the directives are called, and what they share.
#pragma once

#include "core/pbrt/lexer.h"
#include "core/pbrt/parameters.h"
#include "core/pbrt/state.h"

#include <string>

namespace lockstep::pbrt {

// One use of a directive: where it stands, and the lexer to read its arguments from.
struct Call {
  Lexer& lexer;
  std::string name;
  Location where;

  std::string read_name(const char* what) const {
    return lexer.expect_string(std::string(what) + " in quotes after " + name);
  }
  ParameterSet read_parameters(const std::string& type) const {
    return {lexer, name + " \"" + type + "\"", where};
  }
};

// The parameters after `type`, and those that Attribute gave for `target`.
ParameterSet with_defaults(const State& state, const Call& call, const std::string& type,
                           const char* target);

// Scopes (directives.cpp).
void push_scope(State& state, const Call& call);
// Closes the scope opened by `begin` and returns what held before it.
Attributes pop_scope(State& state, const Call& call, const char* begin);

// Directives before WorldBegin (options.cpp).
void accelerator(State&, const Call&);
void camera(State&, const Call&);
void color_space(State&, const Call&);
void film(State&, const Call&);
void integrator(State&, const Call&);
void option(State&, const Call&);
void pixel_filter(State&, const Call&);
void renderer(State&, const Call&);
void sampler(State&, const Call&);
void surface_integrator(State&, const Call&);
void world_begin(State&, const Call&);
void world_end(State&, const Call&);

// What the world is made of (world.cpp, objects.cpp, media.cpp).
void area_light_source(State&, const Call&);
void attribute(State&, const Call&);
void light_source(State&, const Call&);
void make_named_material(State&, const Call&);
void make_named_medium(State&, const Call&);
void material(State&, const Call&);
void medium_interface(State&, const Call&);
void named_material(State&, const Call&);
void object_begin(State&, const Call&);
void object_end(State&, const Call&);
void object_instance(State&, const Call&);
void shape(State&, const Call&);
void texture(State&, const Call&);
void volume(State&, const Call&);

}  // namespace lockstep::pbrt
