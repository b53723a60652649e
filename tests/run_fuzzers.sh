#!/usr/bin/env bash
# Builds the fuzz targets with clang and runs each of them: run_fuzzers.sh [seconds for each, 60] [seed, another each
# time]
#
# New inputs stay in build/fuzz/corpus between runs. An input that fails is left in build/fuzz as crash-…; repeat it
# with build/fuzz/bin/fuzz_core FILE. It belongs into tests/fuzz/corpus once it is mended.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export DRAPE_WARNINGS_AS_ERRORS=${DRAPE_WARNINGS_AS_ERRORS-ON}
seconds=${1:-60}
seed=${2:-0}  # 0: libFuzzer chooses, and prints it

bash cmake/install_packages.sh
bash cmake/build_preset.sh fuzz fuzz_mesh fuzz_records fuzz_core fuzz_queries

export LSAN_OPTIONS=suppressions=$PWD/cmake/lsan.supp:print_suppressions=0
cd build/fuzz
for target in mesh records core queries; do
  mkdir -p "corpus/$target"
  echo "fuzz_$target for $seconds s" >&2
  # Leaks are looked for at the end; -close_fd_mask hides what readers print.
  ./bin/fuzz_$target -seed="$seed" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=4096 \
    -close_fd_mask=1 -print_final_stats=1 "corpus/$target" "../../tests/fuzz/corpus/$target"
done
