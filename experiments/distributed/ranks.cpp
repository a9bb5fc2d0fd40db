#include "experiments/distributed/ranks.h"

#include "core/error.h"

#include <fmt/format.h>

#include <cstdlib>
#include <list>
#include <mutex>
#include <set>
#include <utility>

#ifdef LOCKSTEP_MPI
#include <mpi.h>
#endif

namespace lockstep {
namespace {

std::optional<int> number_from(const char* variable) {
  const char* text = std::getenv(variable);
  if (!text || *text == '\0') return {};
  return std::atoi(text);
}

struct Launch {
  int rank = 0;
  int count = 1;
  bool has_mpi = false;  // the launcher speaks to MPI
};

Launch find_launch() {
  for (const auto& [rank, count] : {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                    std::pair{"PMI_RANK", "PMI_SIZE"}}) {
    if (number_from(rank) && number_from(count).value_or(1) > 1) {
      return {*number_from(rank), *number_from(count), true};
    }
  }
  // srun sets these for its tasks; the shell of a batch job has no number of tasks in its step.
  const int tasks = number_from("SLURM_STEP_NUM_TASKS").value_or(1);
  if (tasks < 2) return {};
  return {number_from("SLURM_PROCID").value_or(0), tasks, number_from("PMIX_RANK").has_value()};
}

}  // namespace

std::optional<int> launched_rank() {
  const Launch launch = find_launch();
  if (launch.count < 2) return {};
  return launch.rank;
}

#ifdef LOCKSTEP_MPI

namespace {

struct Sent {
  MPI_Request request = MPI_REQUEST_NULL;
  std::vector<char> bytes;
};

struct Arriving {
  MPI_Request request = MPI_REQUEST_NULL;
  Message message;
};

// All calls of MPI are under the lock: it is started for one thread at a time.
struct Link {
  std::mutex mutex;
  bool started = false;
  std::list<Sent> sent;
  std::list<Arriving> arriving;
  Traffic traffic;
};

Link& link() {
  static Link link;
  return link;
}

// Forgets what the other sides have taken.
void clear_sent(Link& l) {
  for (auto place = l.sent.begin(); place != l.sent.end();) {
    int done = 0;
    MPI_Test(&place->request, &done, MPI_STATUS_IGNORE);
    place = done ? l.sent.erase(place) : std::next(place);
  }
}

void begin_receiving(Link& l) {
  for (;;) {
    int found = 0, size = 0;
    MPI_Message handle = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &found, &handle, &status);
    if (!found) return;
    MPI_Get_count(&status, MPI_CHAR, &size);
    Arriving& next = l.arriving.emplace_back();
    next.message = {status.MPI_SOURCE, status.MPI_TAG, std::vector<char>(std::size_t(size))};
    MPI_Imrecv(next.message.bytes.data(), size, MPI_CHAR, &handle, &next.request);
  }
}

}  // namespace

Ranks start_ranks() {
  const Launch launch = find_launch();
  if (launch.count < 2) return {};
  if (!launch.has_mpi) {
    throw Error(fmt::format(
        "srun started {} tasks that do not know of each other; give it --mpi=pmix (or pmi2), or "
        "use mpirun",
        launch.count));
  }
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  link().started = true;
  if (provided < MPI_THREAD_SERIALIZED) {
    throw Error("this MPI serves the main thread alone; use one with MPI_THREAD_SERIALIZED");
  }
  Ranks ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.count);
  MPI_Comm node = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  MPI_Comm_size(node, &ranks.on_node);
  MPI_Comm_free(&node);
  return ranks;
}

std::string text_of_rank_0(std::string text) {
  Link& l = link();
  if (!l.started) return text;
  const std::lock_guard lock(l.mutex);
  int size = int(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, MPI_COMM_WORLD);
  text.resize(std::size_t(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, MPI_COMM_WORLD);
  return text;
}

void end_ranks() {
  if (!link().started) return;
  const std::lock_guard lock(link().mutex);
  MPI_Finalize();
  link().started = false;
}

void abort_ranks(int status) {
  if (link().started) MPI_Abort(MPI_COMM_WORLD, status);
}

void send(int to, int kind, std::vector<char> bytes) {
  Link& l = link();
  const std::lock_guard lock(l.mutex);
  clear_sent(l);
  ++l.traffic.messages;
  l.traffic.bytes += bytes.size();
  Sent& next = l.sent.emplace_back(Sent{MPI_REQUEST_NULL, std::move(bytes)});
  MPI_Isend(next.bytes.data(), int(next.bytes.size()), MPI_CHAR, to, kind, MPI_COMM_WORLD,
            &next.request);
}

std::optional<Message> receive() {
  Link& l = link();
  const std::lock_guard lock(l.mutex);
  clear_sent(l);
  begin_receiving(l);
  std::set<int> late;  // ranks whose next message has not arrived in full
  for (auto place = l.arriving.begin(); place != l.arriving.end(); ++place) {
    if (late.contains(place->message.from)) continue;
    int done = 0;
    MPI_Test(&place->request, &done, MPI_STATUS_IGNORE);
    if (!done) {
      late.insert(place->message.from);
      continue;
    }
    Message message = std::move(place->message);
    l.arriving.erase(place);
    ++l.traffic.messages;
    l.traffic.bytes += message.bytes.size();
    return message;
  }
  return {};
}

Traffic traffic() {
  const std::lock_guard lock(link().mutex);
  return link().traffic;
}

#else

Ranks start_ranks() {
  const Launch launch = find_launch();
  if (launch.count < 2) return {};
  throw Error(fmt::format(
      "started as one of {} processes, but compiled without MPI: install libopenmpi-dev and build "
      "with -DLOCKSTEP_MPI=ON, or start one process alone",
      launch.count));
}

std::string text_of_rank_0(std::string text) { return text; }
void end_ranks() {}
void abort_ranks(int) {}
void send(int, int, std::vector<char>) {}
std::optional<Message> receive() { return {}; }
Traffic traffic() { return {}; }

#endif

}  // namespace lockstep
