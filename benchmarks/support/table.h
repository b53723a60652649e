// Rows of measurements, written as CSV and JSON.
//
// A row holds values by column name; the table's columns are those of its rows in the order of first use. A void row
// (its result's hash was not the expected one) keeps what says what it was, and loses its figures: see voidRow().
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace drape::bench
{
using Row = nlohmann::ordered_json;

class Table
{
public:
    void add(const Row& row);
    const std::vector<Row>& rows() const { return m_rows; }
    // Returns true if a row is void.
    bool anyVoid() const;

    // Names on standard error what could not be measured; the program then ends with kExitFailed (finishTable()).
    void leaveOut(const std::string& what);
    bool anyLeftOut() const { return m_anyLeftOut; }

    // Returns a header line and a line per row; texts with commas or quotes are quoted. Missing values are empty.
    std::string csv() const;
    // Returns {"machine": …, "rows": […]}.
    std::string json(const Row& machine) const;

private:
    std::vector<std::string> m_columns;
    std::vector<Row> m_rows;
    bool m_anyLeftOut = false;
};

// Compares row["hash"] with the expected one. Where they differ, "valid" becomes "no" and every number except counts of
// triangles and cloths is removed, so that no figure of a wrong result is ever plotted or quoted; else "valid" is
// "yes". An empty expected hash leaves the row as it is: nothing to compare with.
void judgeRow(Row& row, const std::string& expectedHash);

// Hands over the rows of the JSON that a run wrote before. False, with one line in `error`, when the file is none such.
bool readRows(const std::string& path, const std::function<void(const Row&)>& take, std::string& error);

// Writes to a path, or prints for "-"; nothing for an empty path. False with one line in `error`.
bool writeText(const std::string& path, const std::string& text, std::string& error);
}  // namespace drape::bench
