// Wraps every function of drape/c_api.h: stops exceptions, and keeps the text of the thread's last failure.
#pragma once

#include <string>

#include "bullet_plugin/core/public_call.h"
#include "drape/c_api.h"
#include "drape/error.h"

namespace drape
{
// Remembers the text and returns the code of the error's kind.
DrapeResult failC(const Error& error) noexcept;
// Remembers "call: wrong" and returns DRAPE_BAD_INPUT.
DrapeResult refuseC(const char* call, const char* wrong) noexcept;

// Returns work(), a DrapeResult; the code of the exception if it throws.
template <class Work>
DrapeResult callC(const char* call, const Work& work) noexcept
{
    return guarded(work,
                   [&](const CaughtException& caught)
                   {
                       Error error;
                       setError(error, call, caught);
                       return failC(error);
                   });
}

// Returns the result of a call of the C++ interface, whose object keeps its error.
template <class Object>
DrapeResult resultOf(bool good, const Object& object) noexcept
{
    return good ? DRAPE_OK : failC(object.error());
}

// Keeps the text of work() in `kept` and returns it; "out of memory" if work() throws.
template <class Work>
const char* textC(std::string& kept, const Work& work) noexcept
{
    return guardedOr(kOutOfMemory,
                     [&]
                     {
                         kept = work();
                         return kept.c_str();
                     });
}
}  // namespace drape
