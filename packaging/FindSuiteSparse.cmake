# CHOLMOD, UMFPACK and OpenBLAS as Debian has them: SuiteSparse::SuiteSparse.
find_library(CHOLMOD_LIBRARY cholmod)
find_library(UMFPACK_LIBRARY umfpack)
find_library(OPENBLAS_LIBRARY openblas)
find_path(SUITESPARSE_INCLUDE cholmod.h PATH_SUFFIXES suitesparse)
mark_as_advanced(CHOLMOD_LIBRARY UMFPACK_LIBRARY OPENBLAS_LIBRARY SUITESPARSE_INCLUDE)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS CHOLMOD_LIBRARY UMFPACK_LIBRARY OPENBLAS_LIBRARY
                                                            SUITESPARSE_INCLUDE)
if(SuiteSparse_FOUND AND NOT TARGET SuiteSparse::SuiteSparse)
  add_library(SuiteSparse::SuiteSparse INTERFACE IMPORTED)
  target_include_directories(SuiteSparse::SuiteSparse SYSTEM INTERFACE ${SUITESPARSE_INCLUDE})
  target_link_libraries(SuiteSparse::SuiteSparse INTERFACE ${CHOLMOD_LIBRARY} ${UMFPACK_LIBRARY}
                                                           ${OPENBLAS_LIBRARY})
endif()
