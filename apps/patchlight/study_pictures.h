#pragma once

#include "apps/patchlight/commands.h"
#include "apps/report/study_page.h"

#include <string>
#include <vector>

namespace patchlight {

/// What stands for each of the views in files' names and on pages: a camera's name, a file's stem, "view" for the
/// scene's first; letters, digits, - and _ alone, and each another.
std::vector<std::string> view_labels(const std::vector<StudyView>& views);

/// DIR/pictures/NNN-LABEL.png of a cell by its index.
std::filesystem::path picture_file(const StudyFolder& folder, const StudyCell& cell, const std::string& label);

/// The last solutions of all cells that ran to their end, from all of the study's views, in its size, at its exposure:
/// when it names none, the one that shows its scene's first such cell well from the first view. By views, then by
/// cells. Cells whose scene lacks a view are left out of it, with a warning. Throws SceneError when a stored solution
/// is broken, Interrupted.
std::vector<StudyPicture> study_pictures(const StudyPictures& wanted, const StudyResult& study,
                                         const StudyFolder& folder, Session& session);

/// Writes them to DIR/pictures, and deletes the PNGs there that aren't among them. Throws OutputError.
void write_pictures(const std::vector<StudyPicture>& pictures, const StudyResult& study, const StudyFolder& folder,
                    FileWriter& writer);

}  // namespace patchlight
