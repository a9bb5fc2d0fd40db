#include "experiments/commands/program.h"

#include "core/error.h"
#include "core/location.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/options.h"
#include "experiments/commands/version_text.h"
#include "experiments/distributed/ranks.h"
#include "experiments/output/activity.h"
#include "experiments/output/crash_handler.h"
#include "experiments/output/progress.h"
#include "packets/render.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

namespace lockstep {
namespace {

enum ExitStatus { kDone = 0, kFailed = 1, kWrongUsage = 2 };

// What is wrong with a command line is wrong in all ranks, and rank 0 says it: the others leave it
// the time to do so, as the launcher ends all once one has ended.
int report(std::string message, ExitStatus status) {
  const int rank = launched_rank().value_or(0);
  if (rank > 0 && status == kWrongUsage) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
  } else {
    fmt::print(stderr, "lockstep: {}{}\n", rank > 0 ? fmt::format("rank {}: ", rank) : "",
               printable(std::move(message), ' '));
  }
  abort_ranks(status);
  return status;
}

// Commands that know nothing of other ranks would do the same in all of them.
void refuse_ranks(const CLI::App& program) {
  if (!launched_rank()) return;
  for (const CLI::App* command : program.get_subcommands()) {
    const std::string name = command->get_name();
    if (name == "render" || name == "compare") continue;
    throw UsageError(
        fmt::format("{} is for one process: start it without mpirun or srun; render and compare "
                    "spread over several",
                    name));
  }
}

// TBB names the function that gave it no thread; people want to know what to do.
std::string explained(const std::string& message) {
  if (!message.starts_with("pthread_create")) return message;
  return message + "; not enough memory or processes for another thread: give it more";
}

// Done, unless what was printed has not arrived: the disk that it went to is full.
int done() {
  std::cout.flush();
  const bool arrived = std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (arrived) return kDone;
  return report(fmt::format("the output cannot be written: {}; make room and run it again",
                            std::strerror(errno)),
                kFailed);
}

// Lists subcommands with the first line of their description; their own --help has the rest.
struct HelpFormatter : CLI::Formatter {
  std::string make_subcommand(const CLI::App* command) const override {
    const std::string description = command->get_description();
    return fmt::format("  {:28}{}\n", command->get_name(),
                       description.substr(0, description.find('\n')));
  }
};

// What to do about a command line that could not be understood.
std::string advice(const CLI::App& program) {
  for (const CLI::App* command : program.get_subcommands()) {
    return fmt::format("see 'lockstep {} --help'", command->get_name());
  }
  return "see 'lockstep --help'";
}

void describe(CLI::App& program) {
  program.name("lockstep");
  program.description(
      "Lockstep traces packets of rays that share random numbers, and measures what that buys in\n"
      "speed and costs or saves in error, at equal time.");
  program.footer(
      "Start with:\n"
      "  lockstep demo                             equal-time comparison; 1.5 minutes\n"
      "  lockstep render cornell -o cornell.exr    one image of a built-in scene; seconds\n"
      "  lockstep compare cornell --samplers random,cpt,rcs,owen -o out/cornell\n"
      "\n"
      "Exit status: 0 done, 1 failed while running, 2 wrong usage.");
  program.set_version_flag("--version", version_text);
  program.set_help_flag("-h,--help", "Print this help and exit");
  program.require_subcommand(1);
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->column_width(30);
  formatter->label("REQUIRED", "(required)");
  formatter->label("Excludes", "not with");
  program.formatter(formatter);
}

int run_subcommand(int argc, const char* const* argv) {
  CLI::App program;
  describe(program);
  RunCommand run;
  add_render_command(program, run);
  add_compare_command(program, run);
  add_demo_command(program, run);
  add_profile_command(program, run);
  add_stress_command(program, run);
  add_metrics_command(program, run);
  add_runs_command(program, run);
  add_info_command(program, run);
  add_scenes_command(program, run);
  add_samplers_command(program, run);
  add_shell_commands(program, run);
  refuse_empty_values(program);
  catch_crashes();
  try {
    program.parse(argc, argv);
    refuse_ranks(program);
    catch_interrupts();
    run();
    return done();
  } catch (const CLI::RequiredError& error) {
    const bool unknown = argc > 1 && argv[1][0] != '-' && program.get_subcommands().empty();
    const std::string what =
        unknown ? fmt::format("unknown subcommand '{}'", argv[1]) : std::string(error.what());
    return report(fmt::format("{}; {}", what, advice(program)), kWrongUsage);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      program.exit(error);
      return done();
    }
    return report(fmt::format("{}; {}", error.what(), advice(program)), kWrongUsage);
  } catch (const UsageError& error) {
    return report(fmt::format("{}; {}", error.what(), advice(program)), kWrongUsage);
  }
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  try {
    return run_subcommand(argc, argv);
  } catch (const std::bad_alloc&) {
    return report(out_of_memory_text(), kFailed);
  } catch (const std::length_error&) {  // so large that no allocation was tried
    return report(out_of_memory_text(), kFailed);
  } catch (const std::exception& error) {
    return report(explained(error.what()), kFailed);
  }
}

}  // namespace lockstep
