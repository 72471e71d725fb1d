# Compiler options shared by every target, as one interface library, and the two functions that make targets.
add_library(afterglow_options INTERFACE)
target_include_directories(afterglow_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(afterglow_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)

# Debian's Embree and oneTBB choose their own instruction sets at run time; our loops are built for
# x86-64-v3 (AVX2, FMA), which programs check for when they start.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(afterglow_options INTERFACE -march=x86-64-v3)
endif()
# The same expression must give the same bits wherever the compiler inlines it.
target_compile_options(afterglow_options INTERFACE -ffp-contract=off)

if(AFTERGLOW_WARNINGS_AS_ERRORS)
    target_compile_options(afterglow_options INTERFACE -Werror)
endif()
if(AFTERGLOW_ASSERTIONS)
    string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")
    target_compile_definitions(afterglow_options INTERFACE _GLIBCXX_ASSERTIONS)
endif()
if(AFTERGLOW_SANITIZE)
    target_compile_options(afterglow_options INTERFACE -fsanitize=${AFTERGLOW_SANITIZE} -fno-omit-frame-pointer
                                                       -fno-sanitize-recover=all)
    target_link_options(afterglow_options INTERFACE -fsanitize=${AFTERGLOW_SANITIZE})
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# afterglow_room(NAME [USES room...] [PRIVATE library...]): one static library from all sources of a solver folder.
# A room sees only the rooms it names, which is how the one-way arrows of the design are kept by the linker.
function(afterglow_room name)
    cmake_parse_arguments(ROOM "" "" "USES;PUBLIC;PRIVATE" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
    add_library(afterglow_${name} STATIC ${sources})
    list(TRANSFORM ROOM_USES PREPEND afterglow_)
    target_link_libraries(afterglow_${name} PUBLIC afterglow_options ${ROOM_USES} ${ROOM_PUBLIC}
                                            PRIVATE ${ROOM_PRIVATE})
endfunction()
