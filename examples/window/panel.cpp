#include "examples/window/panel.h"

#include <algorithm>
#include <cstdio>

#include <imgui.h>

#include "drape/debug_draw.h"
#include "examples/window/window_scenes.h"

namespace drape::window
{
namespace
{
const ImVec4 kHeading(0.55f, 0.75f, 1.0f, 1.0f), kDim(0.65f, 0.68f, 0.74f, 1.0f), kWarning(1.0f, 0.6f, 0.35f, 1.0f);

void heading(const char* text)
{
    ImGui::Spacing();
    ImGui::Separator();
    ImGui::TextColored(kHeading, "%s", text);
}

void drawScene(Choices& choices)
{
    if (!ImGui::BeginCombo("scene", choices.m_scene.c_str())) return;
    for (const std::string& name : windowSceneNames())
    {
        if (!ImGui::Selectable(name.c_str(), name == choices.m_scene)) continue;
        choices.m_scene = name;
        choices.m_restarts = true;
    }
    ImGui::EndCombo();
}

void drawRun(Choices& choices)
{
    if (ImGui::Button(choices.m_isPaused ? "Run" : "Pause", ImVec2(78, 0))) choices.m_isPaused = !choices.m_isPaused;
    ImGui::SameLine();
    if (ImGui::Button("Step", ImVec2(78, 0))) choices.m_isPaused = choices.m_stepsOnce = true;
    ImGui::SameLine();
    if (ImGui::Button("Restart", ImVec2(78, 0))) choices.m_restarts = true;
    int who = choices.m_byBullet;
    bool changed = ImGui::RadioButton("Drape", &who, 0);
    ImGui::SameLine();
    changed = ImGui::RadioButton("Bullet's own collision", &who, 1) || changed;
    if (changed && (who == 1) != choices.m_byBullet)
    {
        choices.m_byBullet = who == 1;
        choices.m_restarts = true;
    }
}

void drawShown(Choices& choices)
{
    heading("Show");
    ImGui::Checkbox("cloth's wires", &choices.m_wires);
    if (choices.m_byBullet)
    {
        ImGui::TextColored(kDim, "Contacts are Drape's alone.");
        return;
    }
    ImGui::CheckboxFlags("contacts", &choices.m_draws, kDrawContacts);
    ImGui::SameLine(150);
    ImGui::CheckboxFlags("normals", &choices.m_draws, kDrawNormals);
    ImGui::CheckboxFlags("gaps", &choices.m_draws, kDrawGaps);
    ImGui::SameLine(150);
    ImGui::CheckboxFlags("impulses", &choices.m_draws, kDrawImpulses);
    ImGui::CheckboxFlags("patches", &choices.m_draws, kDrawPatches);
    ImGui::SameLine(150);
    ImGui::CheckboxFlags("flagged pairs", &choices.m_draws, kDrawFlagged);
}

void drawTimes(const Simulation& simulation)
{
    heading("Times");
    ImGui::Text("frame %d", simulation.steps());
    ImGui::Text("%6.2f ms  last frame", simulation.stepMs());
    ImGui::Text("%6.2f ms  mean of the last 120", simulation.meanStepMs());
    const std::array<float, 120>& history = simulation.history();
    const float most = *std::max_element(history.begin(), history.end());
    ImGui::PlotHistogram("##times", history.data(), int(history.size()), 0, nullptr, 0, most, ImVec2(254, 46));
    if (simulation.isByBullet()) return;
    const StepStatistics& step = simulation.plugin().statistics();
    ImGui::Text("%6.2f ms  Drape", step.callsMs());
    ImGui::TextColored(kDim, "%6.2f    detection", step.m_uploadMs + step.m_waitMs + step.m_writeMs);
    ImGui::TextColored(kDim, "%6.2f    links and contacts", step.solverMs());
    ImGui::TextColored(kDim, "%6.2f    prediction, normals", step.m_predictMs + step.m_normalsMs);
}

void drawCounts(const Simulation& simulation)
{
    if (simulation.isByBullet()) return;
    const StepStatistics& step = simulation.plugin().statistics();
    heading("Last step");
    ImGui::Text("%7zu  cloth triangles", step.m_clothTriangles);
    ImGui::Text("%7zu  obstacle triangles", step.m_obstacleTriangles);
    ImGui::Text("%7zu  contacts with obstacles", step.m_contacts);
    ImGui::Text("%7zu  contacts of cloth", step.m_selfContacts);
    const std::size_t flagged = simulation.plugin().flaggedPairs().size();
    if (flagged > 0) ImGui::TextColored(kWarning, "%7zu  flagged pairs", flagged);
    const std::string status = statusText(step.m_status);
    if (!status.empty()) ImGui::TextColored(kWarning, "%s", status.c_str());
    ImGui::TextColored(kDim, "on %s", simulation.plugin().device().m_device.m_name.c_str());
}
}  // namespace

void styleAsPanel()
{
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 6;
    style.FrameRounding = 4;
    style.WindowPadding = ImVec2(12, 10);
    style.ItemSpacing = ImVec2(8, 5);
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.09f, 0.11f, 0.15f, 0.93f);
    style.Colors[ImGuiCol_PlotHistogram] = ImVec4(0.4f, 0.65f, 1.0f, 1.0f);
    ImGui::GetIO().IniFilename = nullptr;
}

void drawPanel(const Simulation& simulation, Choices& choices)
{
    ImGui::SetNextWindowPos(ImVec2(14, 14), ImGuiCond_Once);
    ImGui::SetNextWindowSize(ImVec2(290, 0), ImGuiCond_Once);
    ImGui::Begin("Drape", nullptr, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushItemWidth(196);
    drawScene(choices);
    drawRun(choices);
    drawShown(choices);
    drawTimes(simulation);
    drawCounts(simulation);
    if (!choices.m_error.empty()) ImGui::TextColored(kWarning, "%s", choices.m_error.c_str());
    heading("Mouse and keys");
    ImGui::TextColored(kDim,
                       "left: drag cloth, or turn\nright: pan    wheel: nearer\nspace: pause  S: step  R: restart");
    ImGui::PopItemWidth();
    ImGui::End();
}
}  // namespace drape::window
