#include "app/lab/chart/chart_columns.h"

#include "app/lab/csv.h"

namespace plumb {

namespace {

std::vector<std::string_view> parts_of(std::string_view text, std::string_view separator = ";") {
    std::vector<std::string_view> parts;
    while (!text.empty()) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view()
                                             : text.substr(end + separator.size());
    }
    return parts;
}

constexpr std::string_view between_reasons = " | ";

} // namespace

std::string setting_column(SettingNumber number) {
    std::string column = setting_name(number);
    if (const std::string_view unit = number.setting().unit; !unit.empty())
        column += "_" + std::string(unit);
    std::erase(column, '^');
    for (char &c : column)
        if (c == '.' || c == '/')
            c = '_';
    return column;
}

CostColumns::CostColumns(bool wall_clock) {
    const std::string clock = wall_clock ? "wall" : "cpu";
    cost = clock + "_s_per_s";
    least = cost + "_least";
    greatest = cost + "_greatest";
    timings = cost + "_timings";
    worst_step = "worst_step_" + clock + "_s";
}

std::string sweep_text(const std::vector<SweepAxis> &sweep) {
    std::string text;
    for (const SweepAxis &axis : sweep) {
        text += (text.empty() ? "" : ";") + setting_name(axis.setting);
        for (std::size_t i = 0; i < axis.values.size(); ++i)
            text += (i == 0 ? "=" : ",") + exact_number(axis.values[i]);
    }
    return text;
}

std::vector<SweepAxis> parsed_sweeps(std::string_view text) {
    std::vector<SweepAxis> sweep;
    for (const std::string_view part : parts_of(text))
        sweep.push_back(parse_sweep(part));
    return sweep;
}

std::string numbers_text(const std::vector<double> &numbers) {
    std::string text;
    for (const double number : numbers)
        text += (text.empty() ? "" : ";") + exact_number(number);
    return text;
}

std::vector<double> parsed_numbers(std::string_view text) {
    std::vector<double> numbers;
    for (const std::string_view part : parts_of(text))
        if (const std::optional<double> number = csv_number(part))
            numbers.push_back(*number);
    return numbers;
}

std::string reasons_text(const std::vector<std::string> &reasons) {
    std::string text;
    for (const std::string &reason : reasons)
        text.append(text.empty() ? "" : between_reasons).append(reason);
    return text;
}

std::vector<std::string> parsed_reasons(std::string_view text) {
    std::vector<std::string> reasons;
    for (const std::string_view part : parts_of(text, between_reasons))
        reasons.emplace_back(part);
    return reasons;
}

} // namespace plumb
