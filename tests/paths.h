// Where the build put the program and where the sources are. Defined once, in paths.cpp, so that no other object file
// depends on the folder it was built in.
#pragma once

namespace framesim {

extern const char* const kProgramPath;   // build/framesim
extern const char* const kSourceFolder;  // the folder of this checkout

}  // namespace framesim
