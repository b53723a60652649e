// Readers of mesh files, one for each format. Each parses the file's bytes once.
//
// All fill an empty mesh with the file's content and return "". On failure they return one line with the reason. It
// names the line, vertex or face, counted from 1 as in editors. Faces refer to vertices that exist. Positions may be
// NaN or infinite. A truncated file is refused. Memory stays within a small multiple of the file's size, or of the
// meshes that glTF nodes repeat. Any bytes are safe.
#pragma once

#include <functional>
#include <string>

#include "mesh_io/mesh_file.h"

namespace drape
{
// Wavefront OBJ: polygons (f) of vertices (v). Texture coordinates, normals, materials, groups, lines, points and
// free-form surfaces are ignored, also where their indices lead nowhere. Specification: Wavefront, Advanced Visualizer,
// appendix B1.
std::string readObj(const std::string& bytes, MeshFile& mesh);

// PLY: ASCII, binary little-endian and binary big-endian; faces (vertex_indices or vertex_index) and triangle strips
// (tristrips, with -1 between strips). Other elements and properties are skipped. Specification: G. Turk, The PLY
// Polygon File Format, 1994.
std::string readPly(const std::string& bytes, MeshFile& mesh);

// STL: ASCII, also of several solids, and binary, also where its header begins with "solid". Its faces have no indices:
// each gets three vertices of its own.
std::string readStl(const std::string& bytes, MeshFile& mesh);

// Reads the file that a URI names, relative to the glTF file. Returns "" and its bytes, or the reason.
using FindBuffer = std::function<std::string(const std::string& uri, std::string& bytes)>;

// glTF 1.0 and 2.0, as text and as binary (GLB): the triangles, strips and fans of the default scene with their nodes'
// transforms applied. Positions are floats or quantized numbers (KHR_mesh_quantization), also sparse ones. Skins and
// morph targets are not applied. Specification: Khronos, glTF 2.0.
std::string readGltf(const std::string& bytes, const FindBuffer& findBuffer, MeshFile& mesh);
std::string readGlb(const std::string& bytes, const FindBuffer& findBuffer, MeshFile& mesh);
}  // namespace drape
