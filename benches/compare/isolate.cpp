#include "isolate.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include <malloc.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace benches {

namespace {

// A line `NAME:   123 kB` of /proc/self/status.
long long status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == name + ":") {
      long long kib = 0;
      status >> kib;
      return kib * 1024;
    }
  return 0;
}

void write_all(int to, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = write(to, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    done += static_cast<std::size_t>(n);
  }
}

[[noreturn]] void be_the_child(int to, const std::function<nlohmann::json()>& work) {
  nlohmann::json result;
  try {
    result = work();
  } catch (const std::exception& error) {
    result = {{"error", error.what()}};
  } catch (...) {
    result = {{"error", "an exception of unknown type"}};
  }
  write_all(to, result.dump());
  _exit(0); // not exit: the parent's buffers are not this process's to flush
}

} // namespace

void forget_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
}

long long resident_bytes() { return status_bytes("VmRSS"); }

long long peak_bytes() { return status_bytes("VmHWM"); }

nlohmann::json isolated(double limit_seconds, const std::function<nlohmann::json()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (child == 0) {
    close(ends[0]);
    be_the_child(ends[1], work);
  }
  close(ends[1]);

  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_seconds);
  std::string text;
  bool late = false;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
    pollfd reading{ends[0], POLLIN, 0};
    const int ready = left <= 0 ? 0 : poll(&reading, 1, static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) {
      late = true;
      kill(child, SIGKILL);
      break;
    }
    char buffer[4096];
    const ssize_t n = read(ends[0], buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    text.append(buffer, static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (late) return {{"error", "time limit"}, {"limit_seconds", limit_seconds}};
  if (WIFSIGNALED(status)) return {{"error", std::string("ended by a signal: ") + strsignal(WTERMSIG(status))}};
  const nlohmann::json result = nlohmann::json::parse(text, nullptr, false);
  if (!result.is_object()) return {{"error", "no result"}};
  return result;
}

} // namespace benches
