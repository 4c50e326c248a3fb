# Completion of mortier for bash. What can follow is asked of the program itself, so it is never out of date.
_mortier() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local program=${COMP_WORDS[0]} text words word option
  local -a path=()
  COMPREPLY=()

  # The command as far as it is written: words that the help of those before them lists.
  text=$("$program" --help 2>/dev/null) || return
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word == [a-z]* ]] && sed -n '/^Subcommands:/,$p' <<<"$text" | grep -qE "^  $word( |\$)"; then
      path+=("$word")
      text=$("$program" "${path[@]}" --help 2>/dev/null) || return
    fi
  done

  case $previous in
    --out | --restart | --accept | --against) mapfile -t COMPREPLY < <(compgen -d -- "$current"); return ;;
  esac
  # Keys of a scene stand behind --set, one or more.
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do [[ $word == --* ]] && option=$word; done
  if [[ $option == --set && $current != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -S = -W "$("$program" keys | cut -f 1)" -- "$current")
    compopt -o nospace 2>/dev/null
    return
  fi
  words=$(sed -n '/^Subcommands:/,$p' <<<"$text" | sed -nE 's/^  ([a-z][a-z-]*).*/\1/p')
  if [[ $current == -* ]]; then
    words=$(grep -oE '^  +(-h,)?--[a-z-]+' <<<"$text" | grep -oE -- '--[a-z-]+')
  elif [[ -z $words ]]; then
    mapfile -t COMPREPLY < <(compgen -d -S / -- "$current"
                             compgen -f -X '!*.@(toml|mesh|msh|geo|edp)' -- "$current")
    compopt -o nospace 2>/dev/null
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
shopt -s extglob
complete -F _mortier mortier
