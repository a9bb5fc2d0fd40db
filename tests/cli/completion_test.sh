#!/bin/bash
# Completes command lines as bash does, with the script that the program prints; zsh and fish read
# theirs, where they are installed.
# Usage: completion_test.sh PROGRAM
source "$(dirname "$0")/checks.sh"

"$program" completion bash >bash.sh || fail "completion bash"
# shellcheck disable=SC1091
source ./bash.sh
complete -p lockstep 2>/dev/null | grep -q -- '-F _lockstep lockstep' || fail "registers nothing"

# replies LINE: what bash would offer for the end of LINE, its words broken as bash breaks them.
replies() {
  COMP_LINE=$1 COMP_POINT=${#1} COMP_WORDBREAKS=$' \t\n"'"'"'><=;|&(:'
  COMPREPLY=()
  _lockstep
  echo "${COMPREPLY[*]}"
}
offers() { [[ " $(replies "$1") " == *" $2 "* ]] || fail "'$1' does not offer $2: $(replies "$1")"; }
lacks() { [[ " $(replies "$1") " == *" $2 "* ]] && fail "'$1' offers $2"; }
offers_only() { [ "$(replies "$1")" = "$2" ] || fail "'$1' offers $(replies "$1"), not $2"; }

touch 'scene.pbrt' 'two words.pbrt'
mkdir folder
for command in $("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
  offers 'lockstep ' "$command"
  # Every option of its help.
  for option in $("$program" "$command" --help | grep -oE '^ +(-[a-z],)?--[a-z-]+' | tr -d ' ' | tr ',' '\n'); do
    offers "lockstep $command -" "$option"
  done
done
offers_only 'lockstep ren' render
offers_only 'lockstep --v' --version
offers_only 'lockstep render --roulette' --roulette-depth
offers 'lockstep render ' cornell
offers 'lockstep render sc' scene.pbrt
offers 'lockstep compare cornell re' reef
offers_only 'lockstep render two' 'two words.pbrt'
lacks 'lockstep metrics ' cornell
offers_only 'lockstep scenes ' ''
for sampler in random owen rcs strata; do offers 'lockstep render cornell --sampler ' $sampler; done
offers_only 'lockstep render cornell --sampler=zs' zsobol
offers_only 'lockstep compare cornell --samplers random,cp' random,cpt
offers 'lockstep compare cornell --samplers rcs:' c=
offers 'lockstep compare cornell --samplers random,rcs:c=4,of' 4,offset=
offers_only 'lockstep compare cornell --samplers rcs:c=4,offset=fr' fresh
offers_only 'lockstep compare cornell --samplers rcs:c=4,ow' '4,owen'
offers_only 'lockstep render cornell --isa avx5' avx512
offers_only 'lockstep render cornell --traversal stream1m-' stream1m-coherent
offers_only 'lockstep render cornell -o fol' folder
offers_only 'lockstep compare cornell -o ' folder
offers_only 'lockstep render cornell --spp ' ''
offers_only 'lockstep completion z' zsh
offers_only 'lockstep nosuch ' ''

for shell in zsh fish; do
  "$program" completion $shell >script || fail "completion $shell"
  for command in render compare metrics manual; do
    grep -q "$command" script || fail "$shell: no $command"
  done
  command -v $shell >/dev/null || continue
  $shell -n script 2>stderr || fail "$shell cannot read its script: $(cat stderr)"
done
if command -v fish >/dev/null; then
  fish -c 'source script; complete -C "lockstep render cornell --sampler zs"' | grep -q '^zsobol' ||
    fail "fish does not complete samplers"
fi

# The manual page has every command and option, and nothing that troff complains about.
"$program" manual >lockstep.1 || fail "manual"
for command in render compare stress metrics; do
  for option in $("$program" "$command" --help | grep -oE '^ +(-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
    grep -qF -- "${option//-/\\-}" lockstep.1 || fail "the manual lacks $option"
  done
done
if command -v groff >/dev/null; then
  groff -man -ww -Tutf8 lockstep.1 >page 2>stderr
  [ -s stderr ] && fail "groff: $(head -n 5 stderr)"
  grep -q 'lockstep render' page || fail "the page does not read well"
fi

finish
