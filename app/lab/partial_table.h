// What interrupted commands left of a table, and the next of them goes on from.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace plumb {

class PartialTable {
  public:
    // What lies at OutputFile::partial_place(); nothing where there is no such file.
    explicit PartialTable(std::filesystem::path place);

    [[nodiscard]] const std::filesystem::path &place() const { return place_; }
    [[nodiscard]] const std::string &text() const { return text_; }

    // Those of its rows that `table` does not have, as they stand: what the same program found out
    // in an earlier command with other methods, other values or another scene, or what this one was
    // interrupted before. Rows are the same where they have the same in the columns `key`.
    // `fingerprint` is the column with what Fingerprint::text gave: rows of another program are of
    // no use and left out, as are all where `table` has other columns.
    [[nodiscard]] std::string rows_not_in(const std::string &table,
                                          std::span<const std::string> key,
                                          std::string_view fingerprint) const;

    // Writes these of its rows alone, or removes it where there are none.
    void keep_only(const std::string &rows) const;

  private:
    std::filesystem::path place_;
    std::string text_;
};

} // namespace plumb
