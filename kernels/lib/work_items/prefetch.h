// Prefetches data that a CPU's work-item reads soon. For kernels only.
#ifndef DRAPE_LIB_PREFETCH_H
#define DRAPE_LIB_PREFETCH_H

// Prefetches a word without waiting for it. Does nothing on a GPU, which runs other work-items meanwhile.
#ifdef DRAPE_CPU
#define prefetchWord(word) __builtin_prefetch((const void*)(ulong)(word))
#else
#define prefetchWord(word) (void)(word)
#endif

// Items between the prefetch of an item's data and its turn: some hundred nanoseconds of work.
#define DRAPE_AHEAD 8

#endif
