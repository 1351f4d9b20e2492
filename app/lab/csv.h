// Tables as comma-separated values (RFC 4180, but lines end in \n).
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// The shortest decimal that reads back as the same double; "nan", "inf", "-inf".
[[nodiscard]] std::string exact_number(double value);

// Quoted where a comma, a quote or a line break makes it necessary.
[[nodiscard]] std::string csv_field(std::string_view text);

// Writes one table, cell by cell.
class CsvWriter {
  public:
    // `out` must outlive the writer.
    explicit CsvWriter(std::ostream &out) : out_(out) {}

    CsvWriter &cell(std::string_view text);
    CsvWriter &cell(double value);
    CsvWriter &cell(std::uint64_t value);
    CsvWriter &cell(int value);
    CsvWriter &cell(bool value); // 1 or 0
    CsvWriter &cell(const char *text) { return cell(std::string_view(text)); }
    void end_row();

  private:
    void separate();

    std::ostream &out_;
    bool row_begun_ = false;
};

// One row, including quoted cells that span lines; empty at the end. A row cut off by the end is
// dropped.
[[nodiscard]] std::vector<std::string> read_csv_row(std::istream &in);

// Parses what exact_number wrote; nullopt if it is not a number.
[[nodiscard]] std::optional<double> csv_number(std::string_view text);

// Reads one table row by row, with cells looked up by column name.
class CsvReader {
  public:
    // Reads the header row. `in` must outlive the reader.
    explicit CsvReader(std::istream &in);

    // False at the end. Skips rows whose cell count differs from the header's.
    bool next();
    // In the current row; empty if there is no such column.
    [[nodiscard]] std::string_view cell(std::string_view column) const;
    [[nodiscard]] std::optional<double> number(std::string_view column) const {
        return csv_number(cell(column));
    }
    [[nodiscard]] bool has(std::string_view column) const;
    [[nodiscard]] const std::vector<std::string> &names() const { return names_; }

  private:
    std::istream &in_;
    std::vector<std::string> names_, row_;
    std::map<std::string, std::size_t, std::less<>> columns_;
};

} // namespace plumb
