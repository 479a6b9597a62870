#pragma once

namespace hyades::cli {

/// `hyades contact-sheet`: many pictures on one sheet.
int contact_sheet_command(int argc, char** argv);

}  // namespace hyades::cli
