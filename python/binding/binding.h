// Parts of the extension module drape._drape, on which the Python package drape is built.
//
// Arguments have been checked by the package; wrong types raise TypeError all the same. Failures of Drape become
// ValueError (input), MemoryError, or DeviceError.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "drape/error.h"
#include "drape/mesh_description.h"
#include "drape/report.h"
#include "drape/settings.h"

namespace drape
{
namespace py = pybind11;

// An array that is taken as it is: without conversion of its type or layout.
template <class Scalar>
using Array = py::array_t<Scalar, py::array::c_style>;

// Becomes the package's DeviceError.
class DeviceFailure : public std::runtime_error
{
    using std::runtime_error::runtime_error;
};

// Throws the exception of the error's kind. Needs no GIL.
[[noreturn]] void raise(const Error& error);

// Returns the name of a field in Python: "clothsKept" and "m_clothsKept" become "cloths_kept".
std::string pythonName(const std::string& field);

// Returns an entry as that type. Throws TypeError, which names the entry, if it has another type or is out of range.
template <class Value>
Value valueOf(const py::dict& values, const std::string& name)
{
    try
    {
        return values[name.c_str()].template cast<Value>();
    }
    catch (const py::cast_error&)
    {
        throw py::type_error(name + " has the wrong type or is out of range");
    }
}

Settings settingsOf(const py::dict& settings);
py::dict dictOf(const DeviceReport& report);
py::dict dictOf(const StepStatistics& statistics);

// Returns the data of an optional array, null for None.
template <class Scalar>
const Scalar* dataOf(const Array<Scalar>& array)
{
    return array.size() > 0 ? array.data() : nullptr;
}

// Gives an object to one thread at a time while other Python threads run.
class Turn
{
public:
    // Waits for the object without the GIL, and calls work() without it. A call from within work(), such as one of the
    // log, would wait for itself: it throws.
    template <class Work>
    auto run(const Work& work) -> decltype(work())
    {
        const py::gil_scoped_release released;
        if (m_owner.load() == std::this_thread::get_id())
            throw std::runtime_error("the object is in use: its log must not call it");
        const std::lock_guard<std::mutex> lock(m_mutex);
        const Owner owner(m_owner);
        return work();
    }

private:
    using Id = std::atomic<std::thread::id>;
    struct Owner
    {
        explicit Owner(Id& id) : m_id(id) { m_id = std::this_thread::get_id(); }
        ~Owner() { m_id = std::thread::id(); }
        Id& m_id;
    };

    std::mutex m_mutex;
    Id m_owner{};
};

void bindRecords(py::module_& module);
void bindQueries(py::module_& module);
void bindWorld(py::module_& module);
}  // namespace drape
