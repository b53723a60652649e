// The host's kernels for CPUs with AVX-512; CMakeLists.txt has this file compiled for these.
#define DRAPE_KERNEL_SET kernelsOfAvx512
#define DRAPE_SELF_KERNEL_SET selfKernelsOfAvx512
#define DRAPE_INSTRUCTIONS "AVX-512"
#include "kernel_set.h"
