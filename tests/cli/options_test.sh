#!/bin/bash
# Gives every option of every command values that it cannot have: each is refused by its name, in one
# line and with status 2 (1 for files), before anything is done.
# Usage: options_test.sh PROGRAM
source "$(dirname "$0")/checks.sh"

# A line for each option: commands, option, kind, and what belongs to the kind:
#   int LOW HIGH, num LOW HIGH   numbers in a range
#   choice WORD                  one of some words, of which WORD is one
#   list PATTERN VALUE...        refused with PATTERN for each VALUE
#   file                         a file that is to be written or read
#   folder                       a folder that is made where it is missing
# Lists, files and folders may be refused with status 1.
table() {
  cat <<'TABLE'
render             --spp               int 1 16777216
render             --seed              int 0 4294967295
render             --time              num 0.001 1000000000
render             --output            file
render             --stats             file
render             --weights           file
render             --sampler           list sampler|option|number|expected x random:x rcs:c=-1 rcs:c=nan rcs:c=1e99 rcs:pilot=1.5 rcs:t= rcs: random,owen
render             --display           list port|host|HOST x: :1 localhost:99999 localhost:-1 localhost:1.5
render,compare     --rank-timeout      num 0.1 1000000000
render,compare,profile --roulette-depth int 1 1000
render,compare,profile --clamp         num 1e-06 1000000000
render,compare,profile --resolution    list from.1.to.32768 0x5 5 5x -1x5 1.5x5 1000000x1000000 nanxinf 1e2x1e2 5x5x5 5X5 99999999999999999999x1
render,compare,profile --threads       int 0 4096
render,compare,profile --width         choice 8
render,compare,profile --isa           choice avx2
render,compare,profile --lanes         list lane 0x0x0 4x4 4x4x1x1 -4x4x1 99999x99999x99999 4.5x1x1 nan 1e9x1x1 3x5x7
render,compare,profile --traversal     list single packet3 packet single-x none 8
render,compare,profile --camera        list camera|such fov=0 fov=180 fov=nan fov=1e99 origin=1,2 origin=inf,0,0 lens=-1 focus=0 up=0,0,0 nosuch=1 : origin= .
render,compare,profile --environment   list environment 1,2 -1,0,0 nan,0,0 inf,0,0 1e99,0,0 nosuch.exr . 1,2,3,4
render,compare,profile --environment-up choice z
render,compare,profile --intersection   choice fast
render,compare,profile --environment-scale num 0 1000000000
render,profile     --depth             int 1 1000
compare            --depth             list from.1.to.1000 0 -1 1.5 1,x nan 1e99 1001 , 1,,2 99999999999
compare            --spp               list from.1.to.16777216 0 -1 1.5 1,x inf 1e12 16777217 , 4, 99999999999999999999
compare            --seeds             int 1 10000
compare            --samplers          list sampler|twice|option|number|expected x random,x random,random , rcs:c=nan
compare            --time-budgets      list above.0 0 -1 nan inf 1e99 x , 1,,2
compare            --targets           list targets|METRIC|metric nosuch=1 rmse rmse=0 rmse=-1 rmse=nan rmse=inf rmse= =1 , flip_ldr=1e99
compare            --reference         list nosuch|directory|folder|such nosuch.exr .
compare            --reference-spp     int 2 16777216
compare            --timing-spread     num 0 10
compare            --timing-repeats    int 0 10000
compare            --output            folder
compare            --reference-dir     folder
compare            --scenes-dir        list scene nosuch
profile            --output            folder
profile            --weights           list from.0.to.1 2 -1 nan inf x , 0,,1 1e99
profile            --maps              list C:T 4: x -1:0 nan:0 1e99:1 4:0.02:1 , inf:0
profile            --sampler           list sampler|weight|option|number x owen random rcs:c=nan
profile            --spp               int 1 4096
profile            --repeats           int 1 1000
profile            --seeds             int 1 1000
profile            --seed              int 0 4294967295
profile            --reference-spp     int 0 1048576
demo               --threads           int 0 4096
demo               --output            folder
stress             --seeds             int 2 10000
stress             --threads           int 0 4096
stress             --case              list no.case nosuch
stress             --output            folder
metrics            --maps              folder
metrics            --ppd               num 5 1000
metrics            --yee-fov           num 0.1 89.9
metrics            --yee-gamma         num 0.1 10
metrics            --yee-luminance     num 0.01 1000000
metrics            --yee-colour-factor num 0 1
TABLE
}

# What a command cannot do without; an option that is tested comes once more, behind it.
base() {
  case $1 in
    render) echo "render cornell $([ "$2" = --output ] || echo -o a.exr) --spp 1 --resolution 8x8 --quiet" |
      { [ "$2" = --spp ] || [ "$2" = --time ] && sed 's/--spp 1//' || cat; } |
      { [ "$2" = --resolution ] && sed 's/--resolution 8x8//' || cat; } |
      { [ "$2" = --weights ] && sed 's/$/ --sampler rcs/' || cat; } ;;
    compare) echo "compare cornell $([ "$2" = --samplers ] || echo --samplers random) \
      $([ "$2" = --output ] || echo -o out) --quiet \
      $([ "$2" = --scenes-dir ] && echo nosuch.pbrt)" ;;
    profile) echo "profile cornell $([ "$2" = --output ] || echo -o out) --quiet" ;;
    demo) echo "demo --quiet" ;;
    stress) echo "stress --quick --quiet $([ "$2" = --output ] || echo -o out) $([ "$2" = --case ] || echo --case no-light)" ;;
    metrics) echo "metrics a.exr b.exr" ;;
  esac
}

# refused COMMAND OPTION VALUE STATUSES PATTERN
refused() {
  local command=$1 option=$2 value=$3 statuses=$4 pattern=$5 status
  # shellcheck disable=SC2046
  timeout 20 "$program" $(base "$command" "$option") "$option" "$value" >stdout 2>stderr </dev/null
  status=$?
  [[ " $statuses " == *" $status "* ]] ||
    fail "status $status: $command $option '$value': $(head -c 300 stderr)"
  [ "$(grep -vc warning: stderr)" = 1 ] && grep -q '^lockstep: ' stderr ||
    fail "not one line: $command $option '$value': $(head -c 300 stderr)"
  [ -e out ] && fail "leaves a folder: $command $option '$value'" && rm -r out
  grep -qE -- "$pattern" stderr ||
    fail "no '$pattern': $command $option '$value': $(head -c 300 stderr)"
}

# numbers COMMAND OPTION LOW HIGH VALUE...
numbers() {
  local command=$1 option=$2 low=$3 high=$4
  shift 4
  for value in "$@"; do refused "$command" "$option" "$value" 2 "$option: .*from $low to $high"; done
}

touch file
images() { for image in a b; do "$program" render cornell -o $image.exr --spp 1 --resolution 8x8 --quiet; done; }
images

while read -r commands option kind rest; do
  for command in ${commands//,/ }; do
    refused "$command" "$option" '' 2 "$option|value is empty"
    read -ra words <<<"$rest"
    case $kind in
      int)
        numbers "$command" "$option" "${words[0]}" "${words[1]}" $((words[0] - 1)) $((words[1] + 1)) \
          -7 1.5 nan inf -inf 1e99 1e1 x 0x10 99999999999999999999 '1 2'
        ;;
      num)
        numbers "$command" "$option" "${words[0]}" "${words[1]}" -7 nan inf -inf 1e99 1e-999 x 1,5 '1 2'
        ;;
      choice)
        for value in w 3 "${words[0]}x" "${words[0]} " nan; do
          refused "$command" "$option" "$value" 2 "$option: .*not one of .*${words[0]}"
        done
        ;;
      list)
        for value in "${words[@]:1}"; do
          refused "$command" "$option" "$value" "1 2" "${words[0]}"
        done
        ;;
      file)
        refused "$command" "$option" . "1 2" 'folder|ends in'
        refused "$command" "$option" missing/a.exr 1 missing
        refused "$command" "$option" file/a.exr 1 file
        ;;
      folder)
        refused "$command" "$option" file 1 'file: .*folder'
        refused "$command" "$option" file/out 1 'file/out: .*folder'
        ;;
    esac
  done
done < <(table)
# Every option that takes a value stands in the table.
for command in render compare demo profile stress metrics runs info scenes samplers; do
  "$program" "$command" --help | grep -oE '^ +(-[a-z],)?--[a-z-]+ [A-Z]+' | grep -oE -- '--[a-z-]+' |
    while read -r option; do
      table | awk -v c="$command" -v o="$option" '$2 == o && (","$1",") ~ ","c"," { found = 1 }
        END { exit !found }' || echo "$command $option is not tested"
    done
done >missing
[ -s missing ] && fail "$(cat missing)"

# Scenes and images that are folders, empty or missing.
mkdir folder.exr folder.pbrt folder.toml
touch empty.exr empty.pbrt
one_line() {
  timeout 20 "$program" "$@" >stdout 2>stderr </dev/null
  status=$?
  { [ $status = 1 ] || [ $status = 2 ]; } && [ "$(wc -l <stderr)" = 1 ] && grep -q '^lockstep: ' stderr ||
    fail "status $status: lockstep $*: $(head -c 300 stderr)"
}
for scene in folder.pbrt empty.pbrt . '' /dev/null nosuch; do
  one_line render "$scene" -o a.exr
  one_line info "$scene"
  one_line profile "$scene" -o out
  one_line compare "$scene" --samplers random -o out
done
one_line compare folder.toml
for image in folder.exr empty.exr . '' /dev/null nosuch.exr; do
  one_line metrics "$image" a.exr
  one_line metrics a.exr "$image"
done
for directory in nosuch file ''; do one_line runs "$directory"; done

finish
