// Warnings in a form that other programs can act on.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace vkfv {

struct Warning {
    std::string code;     // of its kind, the same whatever the numbers are: "coarse-pixels"
    std::string key;      // of the configuration, dotted: what to change; empty: the configuration has none
    std::string value;    // that the key has, as TOML has it; empty: it is not given, or no single value
    std::string works;    // a value of the key that this warning is not given with, or what helps where no number does
    std::string sentence; // for people, whole: it may say the value and what helps too

    bool operator==(const Warning&) const = default;
};

std::vector<std::string> sentences_of(const std::vector<Warning>& warnings);

// "[key = value; works: ...]", for the line below a sentence; empty without a key.
std::string remedy_text(const Warning& warning);

// Each sentence is a message of the log.
void log_warnings(const std::vector<Warning>& warnings);

// During its life log_warnings() warns once of each code: a series of measurements that are alike has the same warnings
// over and over, which the results of each keep. Further ones are messages of the level "debug".
class WarningsOnce {
  public:
    WarningsOnce();
    ~WarningsOnce();
    WarningsOnce(const WarningsOnce&) = delete;
    WarningsOnce& operator=(const WarningsOnce&) = delete;

  private:
    friend void log_warnings(const std::vector<Warning>& warnings);
    std::set<std::string> codes_;
    WarningsOnce* before_;
};

// Appends the warnings of `further` that are not in the list already.
void append(std::vector<Warning>& warnings, const std::vector<Warning>& further);

// A number as a key's value: with so many digits as tell it to a thousandth, rounded up or down so that it still works.
enum class Rounding { nearest, up, down };
std::string number_text(double value, Rounding rounding = Rounding::nearest);

} // namespace vkfv
