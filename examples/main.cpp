// The command line of lockstep, with what the other files here add to it:
//   lockstep-extended compare cornell --samplers owen,r2,cpt:offset=gradient -o out
#include "experiments/commands/program.h"

void add_r2_sequence();
void add_gradient_offset();
void add_p99_metric();

int main(int argc, char** argv) {
  add_r2_sequence();
  add_gradient_offset();
  add_p99_metric();
  return lockstep::run_program(argc, argv);
}
