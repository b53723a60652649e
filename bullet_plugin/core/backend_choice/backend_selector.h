// Owns both back ends and decides which one runs a scene's steps.
//
// Job: open the device that the settings select, decide by cost between it and the host where nothing names one (see
// backend_choice.h), and continue on the host once the device failed. Output: the back end of the coming step, and a
// report with the reason. Guarantee: a failed device is never used again. Cost: a device that is named is opened at
// once, which builds its kernels (device_start.h). One that cost decides about is opened in the background, and the
// host runs the steps until endStart() takes it.
#pragma once

#include <memory>
#include <vector>

#include "backend_choice.h"
#include "bullet_plugin/core/backends/step_input.h"
#include "bullet_plugin/core/device/device_choice.h"

namespace drape
{
class DeviceBackend;
struct SearchDevice;
class HostBackend;
class SolveStage;
class ThreadTeam;
struct StartedDevice;

class BackendSelector
{
public:
    // Opens nothing: the host runs the steps.
    BackendSelector(const Settings& settings, std::shared_ptr<ThreadTeam> threads);
    ~BackendSelector();

    // Opens the device that the settings select. Returns false, with error filled, if a requested device is missing or
    // fails. If cost decides, begins a start in the background, unless the machine has no driver for it.
    bool open(Error& error);
    // Returns whether a start in the background has ended, and endStart() would not wait.
    bool isStartDone() const;
    // Waits for the start in the background, if there is one, and takes its device. If it failed, the host remains.
    // Returns whether there is a new device. Call between steps.
    bool endStart();
    // Opens the same device as another selector with the same settings, unless it failed there. Takes over its start.
    void reopen(BackendSelector& other);

    const DeviceReport& report() const { return m_report; }
    // The device's failure, or another call's that was noted here.
    Error& lastError() { return m_error; }
    bool deviceFailed() const { return m_deviceFailed; }

    HostBackend& host() { return *m_host; }
    // Returns the back end of the coming step if that is the device; else null.
    DeviceBackend* chosenDevice() { return m_report.m_onHost ? nullptr : m_device.get(); }
    // Returns the open device, also while the host runs the steps and after its failure; null without one.
    Device* device();
    // Returns the time for which its kernels have been compiled so far, ms.
    double compileMs() const;
    // Returns the open device for searches among cloths: a GPU, or one that the settings have cloth solved on. Null
    // without one, and after its failure, which a search may have met.
    SearchDevice searchDevice();

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
    // A start in the background.
    struct Start;

    void leaveDevice(const Error& error);
    bool beginStart(Error& error);
    void take(StartedDevice started);
    void useDevice(std::unique_ptr<DeviceBackend> device);
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
    std::unique_ptr<Start> m_start;  // null: there is none
};
}  // namespace drape
