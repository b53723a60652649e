# Turns the headers' line comments into Doxygen's: the opening block describes the file, a comment line the declaration
# below it, and a comment behind code the declaration before it.
FNR == 1 { print "/// @file"; opening = 1 }
opening && !/^\/\// { opening = 0 }
/^[ \t]*\/\// { sub(/\/\//, "///"); print; next }
/[^ \t].* \/\/ / { sub(/ \/\/ /, " ///< "); print; next }
{ print }
