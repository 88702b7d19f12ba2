#pragma once

#include "meshing/fields.h"
#include "meshing/vectors.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace patchlight {

/// Rows of three doubles, or of one value, as they come from Python; copied where they aren't such already.
using DoubleArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;
using IndexArray = pybind11::array_t<std::uint32_t, pybind11::array::c_style | pybind11::array::forcecast>;

/// A read-only view of values that `owner` holds and keeps where they are: nothing is copied, and the owner lives as
/// long as the view. `shape` is that of the whole array, each entry contiguous.
template <class Number>
pybind11::array view_of(const Number* values, std::vector<pybind11::ssize_t> shape, pybind11::handle owner)
{
    pybind11::array_t<Number> made(std::move(shape), values, owner);
    pybind11::detail::array_proxy(made.ptr())->flags &= ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return made;
}

inline pybind11::array view_of(std::span<const Vec3> values, pybind11::handle owner)
{
    return view_of(reinterpret_cast<const double*>(values.data()), {static_cast<pybind11::ssize_t>(values.size()), 3},
                   owner);
}

template <class Number>
pybind11::array view_of(std::span<const Number> values, pybind11::handle owner)
{
    return view_of(values.data(), {static_cast<pybind11::ssize_t>(values.size())}, owner);
}

/// (n, 3) of a field of colours, (n) of a field of numbers.
template <class IdType, class T>
pybind11::array view_of(const Field<IdType, T>& field, pybind11::handle owner)
{
    return view_of(field.values(), owner);
}

/// (n, 3, 3): patch, edge, band.
inline pybind11::array view_of(const PatchField<std::array<Rgb, 3>>& field, pybind11::handle owner)
{
    return view_of(reinterpret_cast<const double*>(field.values().data()),
                   {static_cast<pybind11::ssize_t>(field.size()), 3, 3}, owner);
}

/// An array that owns what it shows: the vector is moved, not copied.
template <class IdType>
pybind11::array array_of(Field<IdType, Rgb> field)
{
    auto kept = std::make_unique<Field<IdType, Rgb>>(std::move(field));
    const auto& values = *kept;
    const pybind11::capsule owner(kept.get(), [](void* p) { delete static_cast<Field<IdType, Rgb>*>(p); });
    (void)kept.release();
    return view_of(values, owner);
}

/// (n, 3) doubles as a field of n colours. Throws value_error that names `what` for another shape.
template <class FieldType>
FieldType field_of(const DoubleArray& array, std::size_t n, const std::string& what)
{
    if (array.ndim() != 2 || array.shape(0) != static_cast<pybind11::ssize_t>(n) || array.shape(1) != 3)
        throw pybind11::value_error(what + " must have the shape (" + std::to_string(n) + ", 3)");
    const auto* values = reinterpret_cast<const Rgb*>(array.data());
    return FieldType(std::vector<Rgb>(values, values + n));
}

}  // namespace patchlight

namespace pybind11::detail {

/// A place, direction or colour: three numbers in a sequence; a tuple in Python.
template <>
struct type_caster<patchlight::Vec3> {
    PYBIND11_TYPE_CASTER(patchlight::Vec3, const_name("tuple[float, float, float]"));

    bool load(handle source, bool convert)
    {
        const auto numbers = array_t<double, array::c_style | array::forcecast>::ensure(source);
        if (!convert && !isinstance<array>(source)) return false;
        if (!numbers || numbers.ndim() != 1 || numbers.size() != 3) {
            PyErr_Clear();
            return false;
        }
        value = {numbers.data()[0], numbers.data()[1], numbers.data()[2]};
        return true;
    }

    static handle cast(const patchlight::Vec3& v, return_value_policy, handle)
    {
        return make_tuple(v.x, v.y, v.z).release();
    }
};

}  // namespace pybind11::detail
