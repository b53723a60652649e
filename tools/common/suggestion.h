// Finds the known word that a mistyped one most likely stands for: the "did you mean" of Drape's programs.
//
// Words are compared without leading dashes, and without regard to case or to the difference between '-' and '_'.
#pragma once

#include <string>
#include <vector>

namespace drape
{
// Returns the nearest of the known words, or "" if none is near. A word is near if it begins with the text or few
// changes lead from one to the other. A change is a letter inserted, dropped or replaced, or two neighbours swapped;
// one is allowed for every three letters. The first of equally near words wins.
std::string nearestWord(const std::string& text, const std::vector<std::string>& known);

// Returns "; did you mean WORD?" for the nearest word, or "" when none is near.
std::string didYouMean(const std::string& text, const std::vector<std::string>& known);

// Returns the words joined by ", ".
std::string joinedWords(const std::vector<std::string>& words);

// Returns one line for an unknown word, with the nearest known word and the list of all.
std::string unknownWord(const std::string& text, const std::vector<std::string>& known);
}  // namespace drape
