// Text files of numbers: a list a line.
#ifndef LAPIDARY_EXAMPLES_NUMBERS_HPP
#define LAPIDARY_EXAMPLES_NUMBERS_HPP

#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace examples {

// Visits the numbers of each line that has some, with the line's name for messages. Empty lines and comments from `#` on are
// allowed. Throws std::runtime_error naming the line.
template <typename Visit>
void read_numbers(const std::string &path, Visit visit)
{
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": cannot be opened");
    std::string line, word;
    for (long number = 1; std::getline(file, line); ++number) {
        const std::string where = path + ", line " + std::to_string(number);
        std::istringstream words(line.substr(0, line.find('#')));
        std::vector<double> values;
        while (words >> word) {
            std::size_t used = 0;
            double value = 0;
            try {
                value = std::stod(word, &used);
            } catch (const std::exception &) {
                used = 0; // not a number, or out of range
            }
            if (used != word.size()) throw std::runtime_error(where + ": '" + word + "' is not a double");
            values.push_back(value);
        }
        if (!values.empty()) visit(std::move(values), where);
    }
}

} // namespace examples

#endif
