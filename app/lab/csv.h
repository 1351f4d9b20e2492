// Tables as comma-separated values (RFC 4180, but lines end in \n).
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

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

} // namespace plumb
