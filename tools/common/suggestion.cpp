#include "tools/common/suggestion.h"

#include <algorithm>
#include <cctype>

namespace drape
{
namespace
{
std::string plain(const std::string& word)
{
    std::string text = word.substr(std::min(word.find_first_not_of('-'), word.size()));
    for (char& c : text)
        c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

// Returns the Damerau-Levenshtein distance in its restricted form ("optimal string alignment").
std::size_t changesBetween(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> beforeLast, last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
    {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j)
        {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], beforeLast[j - 2] + 1);
        }
        beforeLast = last;
        last = row;
    }
    return last[b.size()];
}

constexpr std::size_t kLongest = 100;  // letters; longer words are not mistyped and would take long to compare

// Returns the number of changes between the two, or a number above any limit when they are not near.
std::size_t changesIfNear(const std::string& text, const std::string& known)
{
    constexpr std::size_t far = 2 * kLongest;
    const std::size_t longer = std::max(text.size(), known.size()), shorter = std::min(text.size(), known.size());
    if (longer > kLongest || shorter == 0) return far;
    if (shorter >= 2 && known.compare(0, text.size(), text) == 0) return 1;
    const std::size_t changes = changesBetween(text, known);
    return changes < shorter && changes <= std::max<std::size_t>(longer / 3, 1) ? changes : far;
}
}  // namespace

std::string nearestWord(const std::string& text, const std::vector<std::string>& known)
{
    const std::string typed = plain(text);
    std::string nearest;
    std::size_t least = kLongest;
    for (const std::string& word : known)
    {
        const std::size_t changes = changesIfNear(typed, plain(word));
        if (changes >= least) continue;
        least = changes;
        nearest = word;
    }
    return nearest;
}

std::string didYouMean(const std::string& text, const std::vector<std::string>& known)
{
    const std::string nearest = nearestWord(text, known);
    return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

std::string joinedWords(const std::vector<std::string>& words)
{
    std::string all;
    for (const std::string& word : words)
        all += (all.empty() ? "" : ", ") + word;
    return all;
}

std::string unknownWord(const std::string& text, const std::vector<std::string>& known)
{
    const std::string nearest = didYouMean(text, known);
    return "there is no '" + text + "'" + (nearest.empty() ? "; there are " : nearest + " There are ") +
           joinedWords(known);
}
}  // namespace drape
