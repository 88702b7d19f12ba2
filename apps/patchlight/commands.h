#pragma once

#include "apps/patchlight/arguments.h"
#include "apps/patchlight/interruption.h"
#include "apps/patchlight/terminal.h"
#include "apps/run/file_writer.h"

namespace patchlight {

/// What every command works with.
struct Session {
    Messages& messages;
    Interruption& interruption;
    FileWriter& writer;
};

/// Each does what its arguments say and returns the exit code; errors are thrown.
int run_command(const SolveCommand& command, Session& session);
int run_command(const DemoCommand& command, Session& session);
int run_command(const InspectCommand& command, Session& session);
int run_command(const RenderCommand& command, Session& session);
int run_command(const ProbeCommand& command, Session& session);
int run_command(const ExportCommand& command, Session& session);
int run_command(const VerifyCommand& command, Session& session);
int run_command(const FormFactorsCommand& command, Session& session);
int run_command(const ValidateCommand& command, Session& session);
int run_command(const CompareCommand& command, Session& session);
int run_command(const AnimateCommand& command, Session& session);
int run_command(const ReportCommand& command, Session& session);
int run_command(const RerunCommand& command, Session& session);
int run_command(const StudyCellCommand& command, Session& session);
int run_command(const StudyRunCommand& command, Session& session);
int run_command(const StudyTableCommand& command, Session& session);
int run_command(const StudyReportCommand& command, Session& session);
int run_command(const StudyCheckCommand& command, Session& session);
int run_command(const PrintCommand& command, Session& session);

}  // namespace patchlight
