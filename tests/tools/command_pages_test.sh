#!/usr/bin/env bash
# Man pages and completions of the programs given as arguments: pages without warnings, completions that work in bash.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

fail() { echo "$*" >&2; exit 1; }

# Prints the completions of a command line whose last word is incomplete.
complete_line() {
  bash -c 'source "$1"; name=$2; shift 2; COMP_WORDS=("$name" "$@"); COMP_CWORD=$#; "_$name"
           printf "%s\n" "${COMPREPLY[@]}"' bash "$folder/$name.bash" "$name" "$@"
}

# Fails unless the completions of the words after the colon are the words before it.
expect() {
  local wanted=()
  while [[ $1 != : ]]; do wanted+=("$1"); shift; done
  shift
  local found
  found=$(complete_line "$@" | tr '\n' ' ')
  [[ $found == "${wanted[*]} " ]] || fail "$name $*: completed to '$found', not '${wanted[*]}'"
}

for program in "$@"; do
  name=$(basename "$program")
  "$program" --man-page > "$folder/$name.1"
  for shell in bash zsh fish; do "$program" --completion "$shell" > "$folder/$name.$shell"; done
  if command -v groff > /dev/null; then
    warnings=$(groff -man -ww -Tutf8 -z "$folder/$name.1" 2>&1)
    [[ -z $warnings ]] || fail "man page of $name: $warnings"
  else
    echo "no groff: the man page of $name is not checked"
  fi
  # Every option of the help is in the page and in the scripts.
  for option in $("$program" --help | grep -oE '^ +(-h,)?--[a-z-]+' | grep -oE -e '--[a-z-]+'); do
    grep -qF -e "${option//-/\\-}" "$folder/$name.1" || fail "$option is not in the man page of $name"
    grep -qF -e "$option" "$folder/$name.bash" || fail "$option is not in the bash completion of $name"
    grep -qF -e "$option" "$folder/$name.zsh" || fail "$option is not in the zsh completion of $name"
    grep -qE -e "-l ${option#--}( |$)" "$folder/$name.fish" || fail "$option is not in the fish completion of $name"
  done
  command -v zsh > /dev/null && zsh -n "$folder/$name.zsh"
  command -v fish > /dev/null && fish -n "$folder/$name.fish"
  expect --version : --vers
  expect bash : --completion b
done

cd "$folder"
touch bunny.obj 'my cloth.obj'
for program in "$@"; do
  name=$(basename "$program")
  case $name in
    cloth_drop)
      expect automatic : --mode a
      expect twist : --scene twi
      expect automatic : --mode = a
      expect 'my cloth.obj' : --obstacle my
      expect bunny.obj : --obstacle bun ;;
    drape_check)
      expect pairs : pai
      expect exact : triangles FILE --mode e
      expect --thickness : pairs --thick ;;
  esac
done
