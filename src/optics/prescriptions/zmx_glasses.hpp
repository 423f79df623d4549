// The glasses of a .zmx file. Only the files of this import include this.
#pragma once

#include "optics/media/glass_catalog.hpp"
#include "optics/prescriptions/zmx_text.hpp"

#include <map>
#include <string>
#include <utility>

namespace vkfv::optics::zmx {

class Glasses {
  public:
    // source: the text that model glasses state as their origin.
    Glasses(const GlassCatalog& catalog, std::string source) : catalog_(catalog), source_(std::move(source)) {}

    // The medium that a GLAS line names: a glass of the catalogues, else a model glass by its six-digit code or by the
    // nd and vd in the line, with a warning in the log. Throws InputError.
    Medium medium_of(const Place& place, const Line& line, const GlassSearch& search);

  private:
    // A model glass named by its six-digit code, with a count appended where several glasses share the code. Zemax's
    // Abbe number 0 means no dispersion.
    Medium model(double nd, double vd);

    const GlassCatalog& catalog_;
    std::string source_;
    std::map<std::string, std::pair<double, double>> models_;
};

} // namespace vkfv::optics::zmx
