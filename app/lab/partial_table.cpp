#include "app/lab/partial_table.h"

#include "app/files/output_file.h"
#include "app/lab/csv.h"
#include "app/lab/fingerprint.h"

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace plumb {

namespace {

std::vector<std::string> cells(const CsvReader &row, std::span<const std::string> columns) {
    std::vector<std::string> values;
    values.reserve(columns.size());
    for (const std::string &column : columns)
        values.emplace_back(row.cell(column));
    return values;
}

} // namespace

PartialTable::PartialTable(std::filesystem::path place) : place_(std::move(place)) {
    if (std::ifstream in(place_, std::ios::binary); in)
        text_.assign(std::istreambuf_iterator<char>(in), {});
}

std::string PartialTable::rows_not_in(const std::string &table, std::span<const std::string> key,
                                      std::string_view fingerprint) const {
    std::istringstream old_in(text_), new_in(table);
    CsvReader old_rows(old_in), new_rows(new_in);
    if (old_rows.names() != new_rows.names())
        return {};
    std::set<std::vector<std::string>> seen;
    while (new_rows.next())
        seen.insert(cells(new_rows, key));
    std::ostringstream left;
    CsvWriter csv(left);
    while (old_rows.next()) {
        if (!old_rows.cell(fingerprint).starts_with(Fingerprint::of_program()) ||
            !seen.insert(cells(old_rows, key)).second)
            continue;
        for (const std::string &cell : cells(old_rows, old_rows.names()))
            csv.cell(cell);
        csv.end_row();
    }
    return left.str();
}

void PartialTable::keep_only(const std::string &rows) const {
    if (rows.empty()) {
        std::filesystem::remove(place_);
        return;
    }
    OutputFile file(place_);
    std::istringstream in(text_);
    CsvWriter head(file.stream());
    for (const std::string &name : read_csv_row(in))
        head.cell(name);
    head.end_row();
    file.stream() << rows;
    file.finish();
}

} // namespace plumb
