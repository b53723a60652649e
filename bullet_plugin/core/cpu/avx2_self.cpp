// The host's kernels of cloths with themselves for CPUs with AVX2; CMakeLists.txt has this file compiled for these.
#define DRAPE_SELF_KERNEL_SET selfKernelsOfAvx2
#include "self_kernel_set.h"
