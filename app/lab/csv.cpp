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

std::vector<std::string> read_csv_row(std::istream &in) {
    std::vector<std::string> row{""};
    bool quoted = false;
    for (int next = in.get(); next != std::istream::traits_type::eof(); next = in.get()) {
        const char c = static_cast<char>(next);
        if (c == '"') {
            if (quoted && in.peek() == '"')
                row.back() += static_cast<char>(in.get());
            else
                quoted = !quoted;
        } else if (c == ',' && !quoted) {
            row.emplace_back();
        } else if (c == '\n' && !quoted) {
            return row;
        } else {
            row.back() += c;
        }
    }
    return {};
}

std::optional<double> csv_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value)
                                                                    : std::nullopt;
}

CsvReader::CsvReader(std::istream &in) : in_(in), names_(read_csv_row(in)) {
    for (std::size_t i = 0; i < names_.size(); ++i)
        columns_.emplace(names_[i], i);
}

bool CsvReader::next() {
    do
        row_ = read_csv_row(in_);
    while (!row_.empty() && row_.size() != names_.size());
    return !row_.empty();
}

std::string_view CsvReader::cell(std::string_view column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() ? std::string_view() : row_[found->second];
}

bool CsvReader::has(std::string_view column) const {
    return columns_.contains(column);
}

} // namespace plumb
