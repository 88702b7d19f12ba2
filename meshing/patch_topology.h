#pragma once

// OpenMesh with double vectors of GLM: what PatchMesh and refinement hold their triangles in.

#include "meshing/vectors.h"

// What OpenMesh asks of a vector type and GLM doesn't have; argument-dependent look-up finds it only here.
namespace glm {

inline double sqrnorm(const dvec3& x)
{
    return dot(x, x);
}
inline double norm(const dvec3& x)
{
    return length(x);
}
inline dvec3& vectorize(dvec3& x, double value)
{
    return x = dvec3(value);
}

}  // namespace glm

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

namespace OpenMesh {

template <>
struct vector_traits<glm::dvec3> {
    using vector_type = glm::dvec3;
    using value_type = double;
    static const size_t size_ = 3;
    static size_t size() { return size_; }
};

}  // namespace OpenMesh

namespace patchlight {

struct PatchMeshTraits : OpenMesh::DefaultTraits {
    using Point = Vec3;
    using Normal = Vec3;
    VertexAttributes(0);
    HalfedgeAttributes(0);
    FaceAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
};

using TriMesh = OpenMesh::TriMesh_ArrayKernelT<PatchMeshTraits>;

}  // namespace patchlight
