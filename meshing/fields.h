#pragma once

#include "meshing/ids.h"
#include "meshing/vectors.h"

#include <cassert>
#include <span>
#include <utility>
#include <vector>

namespace patchlight {

/// One value of type T per id of a mesh, indexed by that kind of id only.
template <class IdType, class T>
class Field {
public:
    Field() = default;
    explicit Field(std::size_t size, T value = T{}) : values_(size, value) {}
    explicit Field(std::vector<T> values) : values_(std::move(values)) {}

    T& operator[](IdType id)
    {
        assert(id.value < values_.size());
        return values_[id.value];
    }
    const T& operator[](IdType id) const
    {
        assert(id.value < values_.size());
        return values_[id.value];
    }

    std::size_t size() const { return values_.size(); }
    bool empty() const { return values_.empty(); }
    std::span<T> values() { return values_; }
    std::span<const T> values() const { return values_; }
    bool operator==(const Field&) const = default;

private:
    std::vector<T> values_;
};

template <class T>
using PatchField = Field<PatchId, T>;
template <class T>
using VertexField = Field<VertexId, T>;

}  // namespace patchlight
