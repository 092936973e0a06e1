// What the example programs understand on their command lines: a table of options, told once, in which order does not matter.
#ifndef LAPIDARY_EXAMPLES_ARGUMENTS_HPP
#define LAPIDARY_EXAMPLES_ARGUMENTS_HPP

#include <lapidary.h>

#include <cstddef>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace examples {

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline long to_count(const std::string &option, const std::string &text, long least, long most)
{
    std::size_t used = 0;
    long value = 0;
    try {
        value = std::stol(text, &used);
    } catch (const std::exception &) {
        used = 0;
    }
    if (used == 0 || used != text.size() || value < least || value > most)
        throw UsageError(option + ": '" + text + "' is not a number from " + std::to_string(least) + " to " +
                         std::to_string(most));
    return value;
}

inline double to_number(const std::string &option, const std::string &text)
{
    std::size_t used = 0;
    double value = 0;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception &) {
        used = 0;
    }
    if (used == 0 || used != text.size()) throw UsageError(option + ": '" + text + "' is not a double");
    return value;
}

inline double to_factor(const std::string &option, const std::string &text)
{
    std::size_t used = 0;
    double value = -1;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception &) {
        used = 0;
    }
    if (used == 0 || used != text.size() || !(value >= 0 && value <= 1000))
        throw UsageError(option + ": '" + text + "' is not a number from 0 to 1000");
    return value;
}

// The largest count that an option takes unless it says otherwise.
constexpr long many_counts = 1000000000;

class Arguments {
public:
    // What `--option` does; it takes its own arguments with next().
    void on(const std::string &option, std::function<void()> action) { actions[option] = std::move(action); }
    void flag(const std::string &option, bool &value)
    {
        on(option, [&value] { value = true; });
    }
    void text(const std::string &option, std::string &value)
    {
        on(option, [this, &value] { value = next(); });
    }
    void count(const std::string &option, long &value, long least, long most = many_counts)
    {
        on(option, [=, &value] { value = to_count(option, next(), least, most); });
    }
    // So many counts, one argument each.
    template <typename Values>
    void counts(const std::string &option, Values &values, long least, long most = many_counts)
    {
        on(option, [=, &values] {
            for (long &value : values) value = to_count(option, next(), least, most);
        });
    }
    // So many doubles, one argument each; infinite ones are for the library to refuse.
    template <typename Values>
    void numbers(const std::string &option, Values &values)
    {
        on(option, [=, &values] {
            for (double &value : values) value = to_number(option, next());
        });
    }
    void factor(const std::string &option, double &value)
    {
        on(option, [=, &value] { value = to_factor(option, next()); });
    }
    // The next argument, which belongs to the option being read.
    const std::string &next()
    {
        if (at == arguments.size()) throw UsageError(current + " needs another argument");
        return arguments[at++];
    }
    // Reads all; `other` is given what is not an option.
    void read(const std::vector<std::string> &given, const std::function<void(const std::string &)> &other)
    {
        arguments = given;
        for (at = 0; at < arguments.size();) {
            current = arguments[at++];
            const auto found = actions.find(current);
            if (found != actions.end()) found->second();
            else if (!current.empty() && current[0] == '-') throw UsageError("unknown option " + current);
            else other(current);
        }
    }

private:
    std::map<std::string, std::function<void()>> actions;
    std::vector<std::string> arguments;
    std::string current;
    std::size_t at = 0;
};

// What every program takes.
struct Common {
    std::string json;
    long threads = 1, repeat = 1;
    bool help = false;

    void declare(Arguments &arguments)
    {
        arguments.flag("--help", help);
        arguments.flag("-h", help);
        arguments.count("--threads", threads, 1, LAP_MAX_THREADS);
        arguments.count("--repeat", repeat, 1);
        arguments.text("--json", json);
    }
};

// What the programs take that cut one mesh.
struct OneMesh : Common {
    std::string mesh, vtu;
    bool check = false, flip = false;

    void declare(Arguments &arguments)
    {
        Common::declare(arguments);
        arguments.flag("--check", check);
        arguments.flag("--flip", flip);
        arguments.text("--vtu", vtu);
    }
    void read(Arguments &arguments, const std::vector<std::string> &given)
    {
        arguments.read(given, [this](const std::string &a) {
            if (!mesh.empty()) throw UsageError("more than one mesh: " + mesh + " and " + a);
            mesh = a;
        });
        if (!help && mesh.empty()) throw UsageError("no mesh given");
    }
};

} // namespace examples

#endif
