// Runs a contestant in a process of its own, so that its peak of memory is its own, a crash of it is an entry in a table,
// and a time limit can end it.
#ifndef LAPIDARY_BENCHES_ISOLATE_HPP
#define LAPIDARY_BENCHES_ISOLATE_HPP

#include <nlohmann/json.hpp>

#include <functional>

namespace benches {

// Forks; the child calls `work`, and what it returns, an object, is the result. After an exception, a signal or the limit
// it is {"error": what happened} instead. Call it from a process with one thread.
nlohmann::json isolated(double limit_seconds, const std::function<nlohmann::json()>& work);

// Memory of this process in bytes. `forget_peak` gives unused memory back and starts the peak anew from what is resident;
// where the system has no such thing, the peak stays that of the whole process.
void forget_peak();
long long resident_bytes();
long long peak_bytes();

} // namespace benches

#endif
