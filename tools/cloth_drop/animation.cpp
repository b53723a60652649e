#include "tools/cloth_drop/animation.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "scenes/atomic_file.h"

namespace drape
{
namespace
{
constexpr PictureSize kSize = {480, 400, 4};
constexpr double kFramesPerSecond = 30;
constexpr float kQuality = 70;  // 100 is the best
constexpr int kPauseMs = 1500;  // at the end, before it begins again

// Returns which frames of the longest run are drawn.
std::vector<std::size_t> framesOf(const std::vector<const Recording*>& runs)
{
    std::size_t count = 0;
    for (const Recording* run : runs)
        count = std::max(count, run->m_frameCount);
    const double rate = 1 / (kFramesPerSecond * runs.front()->m_frameTime);
    const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(rate)));
    std::vector<std::size_t> frames;
    for (std::size_t frame = 0; frame < count; frame += stride)
        frames.push_back(frame);
    return frames;
}

PicturePanel panelAt(const Recording& run, std::size_t frame, std::size_t obstacleTriangles)
{
    PicturePanel panel;
    panel.m_title = run.m_title;
    TriangleMesh& cloth = panel.m_cloth;
    frame = std::min(frame, run.m_frameCount - 1);
    const bool anyRigid =
        std::any_of(run.m_bodies.begin(), run.m_bodies.end(), [](const RecordedBody& body) { return body.m_rigid; });
    for (const RecordedBody& body : run.m_bodies)
    {
        // Without a rigid body the obstacle is a soft one.
        if (body.m_rigid || (!anyRigid && body.m_triangles.size() == 3 * obstacleTriangles)) continue;
        const auto first = static_cast<std::int32_t>(cloth.vertexCount());
        const float* positions = &body.m_frames[frame * body.frameSize()];
        cloth.m_positions.insert(cloth.m_positions.end(), positions, positions + body.frameSize());
        for (const std::int32_t node : body.m_triangles)
            cloth.m_triangles.push_back(first + node);
        for (const std::int32_t node : body.m_lines)
            panel.m_lines.push_back(first + node);
    }
    return panel;
}

struct EncoderEnd
{
    void operator()(WebPAnimEncoder* encoder) const { WebPAnimEncoderDelete(encoder); }
};

class AnimationEncoder
{
public:
    bool add(const Image& image, int timeMs)
    {
        if (!m_encoder)
        {
            WebPAnimEncoderOptions options;
            if (WebPAnimEncoderOptionsInit(&options) == 0) return false;
            m_encoder.reset(WebPAnimEncoderNew(image.m_width, image.m_height, &options));
        }
        WebPConfig config;
        WebPPicture picture;
        if (!m_encoder || WebPConfigPreset(&config, WEBP_PRESET_DRAWING, kQuality) == 0 ||
            WebPPictureInit(&picture) == 0)
            return false;
        picture.use_argb = 1;
        picture.width = image.m_width;
        picture.height = image.m_height;
        const bool added = WebPPictureImportRGB(&picture, image.m_pixels.data(), 3 * image.m_width) != 0 &&
                           WebPAnimEncoderAdd(m_encoder.get(), &picture, timeMs, &config) != 0;
        WebPPictureFree(&picture);
        return added;
    }

    // Returns the file's bytes, or none on failure.
    std::string finish(int timeMs)
    {
        WebPData data;
        WebPDataInit(&data);
        std::string bytes;
        if (m_encoder && WebPAnimEncoderAdd(m_encoder.get(), nullptr, timeMs, nullptr) != 0 &&
            WebPAnimEncoderAssemble(m_encoder.get(), &data) != 0)
            bytes.assign(reinterpret_cast<const char*>(data.bytes), data.size);
        WebPDataClear(&data);
        return bytes;
    }

private:
    std::unique_ptr<WebPAnimEncoder, EncoderEnd> m_encoder;
};

std::vector<PicturePanel> panelsAt(const std::vector<const Recording*>& runs, std::size_t frame,
                                   std::size_t obstacleTriangles)
{
    std::vector<PicturePanel> panels;
    for (const Recording* run : runs)
        panels.push_back(panelAt(*run, frame, obstacleTriangles));
    return panels;
}
}  // namespace

int animationRows(const std::vector<const Recording*>& runs)
{
    return static_cast<int>(framesOf(runs).size() * runs.size()) * kSize.m_height;
}

bool writeAnimation(const std::string& path, const std::vector<const Recording*>& runs, const ObstacleAt& obstacleAt,
                    const PictureHooks& hooks, std::string& error)
{
    const std::vector<std::size_t> frames = framesOf(runs);
    const double frameMs = 1000 * runs.front()->m_frameTime;
    const TriangleMesh last = obstacleAt(frames.back());
    const View view = viewOf(panelAt(*runs.front(), frames.back(), last.triangleCount()).m_cloth, last);
    AnimationEncoder encoder;
    Image image(0, 0);
    int rowsBefore = 0;
    PictureHooks own = hooks;
    own.m_progress = [&](int rows)
    {
        if (hooks.m_progress) hooks.m_progress(rowsBefore + rows);
    };
    for (const std::size_t frame : frames)
    {
        const TriangleMesh obstacle = obstacleAt(frame);
        const auto panels = panelsAt(runs, frame, obstacle.triangleCount());
        if (!drawPicture(panels, obstacle, view, kSize, own, image, error)) break;
        rowsBefore += static_cast<int>(panels.size()) * kSize.m_height;
        if (!encoder.add(image, static_cast<int>(std::lround(static_cast<double>(frame) * frameMs))))
            error = "cannot encode a frame as WebP";
        if (!error.empty()) break;
    }
    const bool whole = rowsBefore == animationRows(runs);
    const auto end = static_cast<int>(std::lround(static_cast<double>(frames.back()) * frameMs)) + kPauseMs;
    const std::string bytes = whole && error.empty() ? encoder.finish(end) : "";
    if (whole && error.empty() && bytes.empty()) error = "cannot assemble the WebP file";
    if (!error.empty()) error = path + ": " + error;
    return !bytes.empty() && writeFileAtomically(path, bytes, error);
}
}  // namespace drape
