// What the programs that compare have in common: contestants one after the other, each in a process of its own, and the report.
#ifndef LAPIDARY_BENCHES_CONTEST_HPP
#define LAPIDARY_BENCHES_CONTEST_HPP

#include "arguments.hpp"
#include "isolate.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace benches {

using Work = std::function<nlohmann::json()>;

// Of two results of one contestant: what begins with "seconds" is the least, "runs" add up, other "_bytes" are the most. A failure stays.
inline void join(nlohmann::json& first, const nlohmann::json& second) {
  if (first.contains("error")) return;
  if (second.contains("error")) {
    first = second;
    return;
  }
  for (auto entry = first.begin(); entry != first.end(); ++entry) {
    const std::string& key = entry.key();
    const nlohmann::json& other = second[key];
    if (key.rfind("seconds", 0) == 0) entry.value() = std::min(entry.value().get<double>(), other.get<double>());
    else if (key == "runs") entry.value() = entry.value().get<long>() + other.get<long>();
    else if (key.size() > 6 && key.compare(key.size() - 6, 6, "_bytes") == 0)
      entry.value() = std::max(entry.value().get<long long>(), other.get<long long>());
  }
}

// Each in a process of its own, one after the other, and the whole list twice, so that what else the machine does is less likely to hit
// one contestant alone. Who failed is not asked again.
inline std::vector<nlohmann::json> contest(double limit_seconds, const std::vector<Work>& works) {
  std::vector<nlohmann::json> results;
  for (const Work& work : works) results.push_back(isolated(limit_seconds, work));
  for (std::size_t i = 0; i < works.size(); ++i)
    if (!results[i].contains("error")) join(results[i], isolated(limit_seconds, works[i]));
  return results;
}

inline void write_report(const std::string& path, const nlohmann::json& report) {
  std::ofstream file(path);
  file << report.dump(2) << '\n';
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

// What `main` does: options, help, the contest, and what is thrown as an exit code.
template <typename Parse, typename Bench>
int run_bench(const char* name, const char* usage, int argc, char** argv, Parse parse, Bench bench) {
  try {
    const auto options = parse(std::vector<std::string>(argv + 1, argv + argc));
    if (!options.help) return bench(options);
    std::cout << usage;
    return 0;
  } catch (const examples::UsageError& error) {
    std::cerr << name << ": " << error.what() << "\n\n" << usage;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 3;
  }
}

} // namespace benches

#endif
