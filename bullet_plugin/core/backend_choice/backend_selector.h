// Owns both back ends and decides which one runs a scene's steps.
//
// Job: open the device that the settings select, decide by cost between it and the host where nothing names one (see
// backend_choice.h), and continue on the host once the device failed. Output: the back end of the coming step, and a
// report with the reason. Guarantee: a failed device is never used again. Cost: opening builds the device's kernels;
// the first start on a machine measures the crossover, in a second or two.
#pragma once

#include <memory>
#include <vector>

#include "backend_choice.h"
#include "bullet_plugin/core/backends/step_input.h"
#include "bullet_plugin/core/device/device_choice.h"

namespace drape
{
class DeviceBackend;
class HostBackend;
class SolveStage;
class ThreadTeam;
struct Crossover;

class BackendSelector
{
public:
    // Opens nothing: the host runs the steps.
    BackendSelector(const Settings& settings, std::shared_ptr<ThreadTeam> threads);
    ~BackendSelector();

    // Opens the device that the settings select. Returns false, with error filled, if a requested device is missing or
    // fails. If a device that was not requested fails, the host remains.
    bool open(Error& error);
    // Opens the same device as another selector with the same settings, unless it failed there.
    void reopen(const BackendSelector& other);

    const DeviceReport& report() const { return m_report; }
    // The device's failure, or another call's that was noted here.
    Error& lastError() { return m_error; }
    bool deviceFailed() const { return m_deviceFailed; }

    HostBackend& host() { return *m_host; }
    // Returns the back end of the coming step if that is the device; else null.
    DeviceBackend* chosenDevice() { return m_report.m_onHost ? nullptr : m_device.get(); }
    // Returns the open device, also while the host runs the steps and after its failure; null without one.
    Device* device();

    // Returns the stage that solves cloths on the device; null if the host should. nodes: see Pipeline::solveStage().
    SolveStage* solveStage(std::size_t nodes);

    // Chooses the back end for the named pairs.
    void choose(const Scene& scene, const StepInput& input);
    // Forgets a mesh's part of the work.
    void forget(MeshId mesh);
    // Counts the work anew in the next step.
    void forgetPairs() { m_countedPairs.clear(); }

    // Makes a device ready for cloths that collide with themselves.
    void prepareSelf();
    // Updates the data of each back end that may run the next step.
    void prepare(const Scene& scene);
    // Releases memory that only earlier, larger steps needed.
    void giveBackRoom();
    // Continues on the host for good after the device's failure.
    void leaveDevice();

private:
    void leaveDevice(const Error& error);
    // Returns null, with error filled, if the device cannot be opened or its kernels cannot be built.
    std::unique_ptr<DeviceBackend> makeDeviceBackend(Error& error) const;
    bool openDevice(Error& error);
    // Lets cost decide from now on. Returns false if the crossover is set to an invalid value.
    bool decideByCost(Error& error);
    // Reads the crossover from the cache, or measures it. Leaves a device that fails meanwhile.
    double findCrossover();
    // Measures on back ends of its own, which are closed afterwards; the cache has the kernels by then. Returns null,
    // or why the device cannot be used.
    const char* measureCrossover(Crossover& crossover, bool& busy, Error& error) const;
    // Selects the back end of the coming steps by the scene's work, and updates the report.
    void selectByWork();
    // Returns whether the host may run the steps of all current meshes. If cost decides, assumes pairs of a thickness
    // near zero, which make the least work.
    bool mayUseHost(const Scene& scene) const;

    const Settings m_settings;
    std::shared_ptr<ThreadTeam> m_threads;
    DeviceChoice m_wanted;  // the device that the settings select
    DeviceReport m_report;
    Error m_error;
    bool m_deviceFailed = false;
    std::unique_ptr<DeviceBackend> m_device;
    std::unique_ptr<HostBackend> m_host;
    BackendChoice m_choice;                 // active where cost decides
    std::vector<NamedPair> m_countedPairs;  // pairs whose work m_choice knows
    std::vector<MeshId> m_countedSelf;
};
}  // namespace drape
