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

// The file `name` of the scene: beside the file that mentions it, or beside the main file.
std::string resolve(const State& state, const std::string& mentioned_in, const std::string& name);

// Directives before WorldBegin (options.cpp).
void accelerator(State&, const Call&);
void camera(State&, const Call&);
void color_space(State&, const Call&);
void film(State&, const Call&);
void integrator(State&, const Call&);
void option(State&, const Call&);
void pixel_filter(State&, const Call&);
void sampler(State&, const Call&);
void world_begin(State&, const Call&);
void world_end(State&, const Call&);

// What the world is made of (world.cpp).
void area_light_source(State&, const Call&);
void attribute(State&, const Call&);
void light_source(State&, const Call&);
void make_named_material(State&, const Call&);
void material(State&, const Call&);
void media(State&, const Call&);
void named_material(State&, const Call&);
void shape(State&, const Call&);
void texture(State&, const Call&);

}  // namespace lockstep::pbrt
