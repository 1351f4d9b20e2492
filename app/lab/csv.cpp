#include "app/lab/csv.h"

#include <array>
#include <charconv>

namespace plumb {

std::string exact_number(double value) {
    std::array<char, 40> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    (void)error; // 24 characters hold every double
    return {text.data(), end};
}

std::string csv_field(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos)
        return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"')
            quoted += '"';
        quoted += c;
    }
    return quoted + '"';
}

void CsvWriter::separate() {
    if (row_begun_)
        out_ << ',';
    row_begun_ = true;
}

CsvWriter &CsvWriter::cell(std::string_view text) {
    separate();
    out_ << csv_field(text);
    return *this;
}

CsvWriter &CsvWriter::cell(double value) {
    separate();
    out_ << exact_number(value);
    return *this;
}

CsvWriter &CsvWriter::cell(std::uint64_t value) {
    separate();
    out_ << value;
    return *this;
}

CsvWriter &CsvWriter::cell(int value) {
    separate();
    out_ << value;
    return *this;
}

CsvWriter &CsvWriter::cell(bool value) {
    separate();
    out_ << (value ? '1' : '0');
    return *this;
}

void CsvWriter::end_row() {
    out_ << '\n';
    row_begun_ = false;
}

} // namespace plumb
