# Sourced from the repository's root: published data for the tests, where it is there.
#
# Input: DRAPE_DATA_ARCHIVE, a folder with an unpack.sh (default: none). Unpacks it into build/data and sets
# DRAPE_TRUTH_DIR and DRAPE_MODELS_DIR. Without one the tests that need them say so and are skipped, unless both are set
# already; with DRAPE_TEST_NEED_DATA=1 they fail.
archive=${DRAPE_DATA_ARCHIVE:-}
if [[ -n $archive && -f $archive/unpack.sh ]]; then
  sh "$archive/unpack.sh" build/data
  export DRAPE_TRUTH_DIR=$PWD/build/data/truth DRAPE_MODELS_DIR=$PWD/build/data/models
fi
