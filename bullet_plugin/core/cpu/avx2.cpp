// The host's kernels for CPUs with AVX2; CMakeLists.txt has this file compiled for these.
#define DRAPE_KERNEL_SET kernelsOfAvx2
#define DRAPE_SELF_KERNEL_SET selfKernelsOfAvx2
#define DRAPE_INSTRUCTIONS "AVX2"
#include "kernel_set.h"
