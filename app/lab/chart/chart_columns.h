// The cell formats chart_table.cpp writes and chart_rows.cpp reads.
#pragma once

#include "app/lab/run/sweep.h"

#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// "dt_s", "gravity_y_m_s2"
[[nodiscard]] std::string setting_column(SettingNumber number);

// Names of the columns for a run's times; they tell which clock measured them.
struct CostColumns {
    explicit CostColumns(bool wall_clock);
    std::string cost, least, greatest, timings, worst_step;
};

// "substeps=1,2;dt=0.01,0.02", without rounding; parsed_sweeps reads it back.
[[nodiscard]] std::string sweep_text(const std::vector<SweepAxis> &sweep);
[[nodiscard]] std::vector<SweepAxis> parsed_sweeps(std::string_view text);

// "0.1;0.2", without rounding; parsed_numbers reads it back, skipping anything that is not a
// number.
[[nodiscard]] std::string numbers_text(const std::vector<double> &numbers);
[[nodiscard]] std::vector<double> parsed_numbers(std::string_view text);

// Why methods were left out, as one cell; parsed_reasons reads it back.
[[nodiscard]] std::string reasons_text(const std::vector<std::string> &reasons);
[[nodiscard]] std::vector<std::string> parsed_reasons(std::string_view text);

} // namespace plumb
