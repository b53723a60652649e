#include "benchmarks/support/table.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "scenes/atomic_file.h"

namespace drape::bench
{
namespace
{
// Inputs, the only numbers that a void row keeps.
const char* const kInputs[] = {
    "triangles", "cloths", "cloth_triangles", "obstacle_triangles", "thickness_m", "threads", "step", "dop",
    "decay",     "value",  "activation",      "substeps",           "iterations",  "voxel_m", "seed"};

std::string cell(const Row& value)
{
    if (value.is_null()) return "";
    if (value.is_number_float())
    {
        char text[32];
        std::snprintf(text, sizeof text, "%.6g", value.get<double>());
        return text;
    }
    if (!value.is_string()) return value.dump();
    const std::string text = value;
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}
}  // namespace

void Table::add(const Row& row)
{
    for (const auto& item : row.items())
    {
        if (std::find(m_columns.begin(), m_columns.end(), item.key()) == m_columns.end())
            m_columns.push_back(item.key());
    }
    m_rows.push_back(row);
}

bool Table::anyVoid() const
{
    return std::any_of(m_rows.begin(), m_rows.end(), [](const Row& row) { return row.value("valid", "") == "no"; });
}

void Table::leaveOut(const std::string& what)
{
    std::cerr << "left out: " << what << std::endl;
    m_anyLeftOut = true;
}

std::string Table::csv() const
{
    std::string text;
    for (std::size_t i = 0; i < m_columns.size(); ++i)
        text += (i > 0 ? "," : "") + m_columns[i];
    text += "\n";
    for (const Row& row : m_rows)
    {
        for (std::size_t i = 0; i < m_columns.size(); ++i)
            text += (i > 0 ? "," : "") + (row.contains(m_columns[i]) ? cell(row[m_columns[i]]) : std::string());
        text += "\n";
    }
    return text;
}

std::string Table::json(const Row& machine) const
{
    Row all;
    all["machine"] = machine;
    all["rows"] = m_rows;
    return all.dump(1) + "\n";
}

void judgeRow(Row& row, const std::string& expectedHash)
{
    if (expectedHash.empty()) return;
    const bool good = row.value("hash", "") == expectedHash;
    row["valid"] = good ? "yes" : "no";
    if (good) return;
    std::vector<std::string> removed;
    for (const auto& item : row.items())
    {
        const bool input = std::find(std::begin(kInputs), std::end(kInputs), item.key()) != std::end(kInputs);
        if (item.value().is_number() && !input) removed.push_back(item.key());
    }
    for (const std::string& key : removed)
        row.erase(key);
}

bool readRows(const std::string& path, const std::function<void(const Row&)>& take, std::string& error)
{
    try
    {
        std::ifstream file(path);
        const Row all = Row::parse(file);
        for (const Row& row : all.at("rows"))
            take(row);
    }
    catch (const Row::exception&)  // invalid JSON, or JSON without the keys
    {
        error = path + ": not the JSON of an earlier run";
    }
    return error.empty();
}

bool writeText(const std::string& path, const std::string& text, std::string& error)
{
    if (path.empty()) return true;
    if (path != "-") return writeFileAtomically(path, text, error);
    std::cout << text << std::flush;
    if (!std::cout) error = "standard output: cannot write";
    return error.empty();
}
}  // namespace drape::bench
