// Wraps every public function: sets the default floating-point environment and stops exceptions.
//
// Work that may throw, which is all that allocates, runs within guarded(). Nothing else of the library catches
// exceptions for the sake of the interface.
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include "drape/error.h"
#include "float_environment.h"

namespace drape
{
// Short enough for a std::string to hold without allocating.
constexpr const char* kOutOfMemory = "out of memory";

// Describes an exception that ended a public function.
struct CaughtException
{
    bool m_isMemory;     // else a fault of Drape or of code that it calls
    const char* m_text;  // valid within the handler
};

// Converts it to an error. `call` names the function.
inline void setError(Error& error, const char* call, const CaughtException& caught) noexcept
{
    error.m_kind = caught.m_isMemory ? ErrorKind::Memory : ErrorKind::Environment;
    try
    {
        error.m_detail = caught.m_text;
        error.m_call = call;
    }
    catch (...)
    {
        error.m_detail.clear();
        error.m_call = kOutOfMemory;
        error.m_kind = ErrorKind::Memory;
    }
}

// Returns work(), or failed(const CaughtException&) if work() throws. failed() must not throw.
template <class Work, class Failed>
auto guarded(const Work& work, const Failed& failed) noexcept -> decltype(work())
{
    const DefaultFloats floats;
    try
    {
        return work();
    }
    catch (const std::bad_alloc&)
    {
        return failed(CaughtException{true, kOutOfMemory});
    }
    catch (const std::length_error&)
    {
        return failed(CaughtException{true, kOutOfMemory});
    }
    catch (const std::exception& exception)
    {
        return failed(CaughtException{false, exception.what()});
    }
    catch (...)
    {
        return failed(CaughtException{false, "unknown exception"});
    }
}

// Does the same with a value, made without allocating, in place of failed().
template <class Work, class Value>
auto guardedOr(Value value, const Work& work) noexcept -> decltype(work())
{
    return guarded(work, [&](const CaughtException&) -> decltype(work()) { return std::move(value); });
}
}  // namespace drape
