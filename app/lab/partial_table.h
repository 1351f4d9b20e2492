// The partial table that an interrupted command leaves behind and the next one resumes from.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace plumb {

class PartialTable {
  public:
    // `place` is OutputFile::partial_place(); the table is empty if there is no such file.
    explicit PartialTable(std::filesystem::path place);

    [[nodiscard]] const std::filesystem::path &place() const { return place_; }
    [[nodiscard]] const std::string &text() const { return text_; }

    // The rows that are not in `table`, verbatim: results of the same program from an earlier
    // command with other methods, values or another scene, or rows this command did not get to
    // before it was interrupted. Rows are equal if their `key` columns are. `fingerprint` names the
    // column holding Fingerprint::text: rows of another program are useless and left out, as are
    // all rows if `table` has other columns.
    [[nodiscard]] std::string rows_not_in(const std::string &table,
                                          std::span<const std::string> key,
                                          std::string_view fingerprint) const;

    // Rewrites the file with only these rows, or removes it if there are none.
    void keep_only(const std::string &rows) const;

  private:
    std::filesystem::path place_;
    std::string text_;
};

} // namespace plumb
