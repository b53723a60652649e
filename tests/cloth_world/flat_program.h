// A C99 program that uses the C interface; see flat_program.c.
#ifndef DRAPE_TEST_FLAT_PROGRAM_H
#define DRAPE_TEST_FLAT_PROGRAM_H

#include "drape/c_api.h"

#ifdef __cplusplus
extern "C"
#endif
    // Returns null if all results are as expected, else the condition that does not hold.
    const char*
    runFlatProgram(void);

#endif
