# What our libraries are built on, an entry as find_package takes it: for our own build, and for whoever finds us
# installed. CONFIG: CGAL brings a FindOpenMesh of its own that finds nothing on Debian.
set(patchlight_dependencies
  "embree 3"
  "OpenMesh CONFIG"
  "Boost"
  "glm"
  "TBB"
  "tinyobjloader"
  "TinyGLTF"
  "nlohmann_json"
  "fmt"
  "OpenSSL COMPONENTS Crypto")
