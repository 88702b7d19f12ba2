#pragma once

#include "apps/run/file_writer.h"
#include "formfactor/form_factors.h"
#include "meshing/patch_mesh.h"

#include <filesystem>
#include <functional>

namespace patchlight {

/// Called now and then while a file is written; what it throws stops the writing, and no file is left.
using Checkpoint = std::function<void()>;

/// The matrix as CSV: row,column,factor with 17 digits, a line for each stored factor. Throws OutputError.
void write_factors_csv(const std::filesystem::path& file, const FormFactorMatrix& matrix, FileWriter& writer,
                       const Checkpoint& check);

/// The matrix as compressed rows, little-endian: 8 bytes "PLFFCSR1", uint64 n, uint64 entries, uint64 row_start[n+1],
/// uint32 columns[entries], float64 factors[entries], float64 area[n] (m²). Throws OutputError.
void write_factors_binary(const std::filesystem::path& file, const FormFactorMatrix& matrix,
                          const PatchField<double>& areas, FileWriter& writer, const Checkpoint& check);

/// What the rows are, as CSV: patch,surface,object,area,x,y,z,nx,ny,nz: area in m², the centroid in the scene file's
/// coordinates, the front's normal. Throws OutputError.
void write_patches_csv(const std::filesystem::path& file, const Scene& scene, const PatchMesh& mesh, FileWriter& writer,
                       const Checkpoint& check);

}  // namespace patchlight
