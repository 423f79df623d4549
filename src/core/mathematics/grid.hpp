// A plain two-dimensional array with x along columns.
#pragma once

#include <cstddef>
#include <vector>

namespace vkfv {

// A two-dimensional array values[row * columns + column]; column ascends with x and row with y of the specimen (row 0
// is the lowest y). Files that are viewed from the top reverse the rows; each writer states it.
template <class Value>
struct Grid {
    int columns = 0;
    int rows = 0;
    std::vector<Value> values;

    Grid() = default;
    Grid(int columns_, int rows_, Value fill = {})
        : columns(columns_), rows(rows_),
          values(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), fill) {}

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    }
    Value& operator()(int column, int row) { return values[index(column, row)]; }
    const Value& operator()(int column, int row) const { return values[index(column, row)]; }
};

} // namespace vkfv
