// Prefetches data that a CPU's work-item reads soon. For kernels only.
#ifndef DRAPE_LIB_ASK_FOR_H
#define DRAPE_LIB_ASK_FOR_H

// Does not wait for the word. Nothing on a GPU, which has other work-items meanwhile.
#ifdef DRAPE_CPU
#define askFor(word) __builtin_prefetch((const void*)(ulong)(word))
#else
#define askFor(word) (void)(word)
#endif

// Items between asking for what one reads and its turn: some hundred nanoseconds' work.
#define DRAPE_AHEAD 8

#endif
