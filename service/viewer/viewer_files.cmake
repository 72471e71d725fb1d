# Makes viewer_files.cpp and sets `viewer_source` to it. The chart's library comes from npm, locked by its checksum; where npm or
# the way to its registry is missing, the page shows a table in place of the chart.
set(folder ${CMAKE_CURRENT_LIST_DIR})
set(made ${CMAKE_CURRENT_BINARY_DIR}/viewer)
set(chart_library ${made}/node_modules/uplot/dist)
find_program(NPM npm)
if(NPM AND NOT EXISTS ${chart_library})
    file(COPY ${folder}/package.json ${folder}/package-lock.json DESTINATION ${made})
    execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
                    WORKING_DIRECTORY ${made} TIMEOUT 120 OUTPUT_QUIET)
endif()

file(GLOB viewer_files CONFIGURE_DEPENDS ${folder}/*.html ${folder}/*.css ${folder}/*.js)
if(EXISTS ${chart_library})
    list(APPEND viewer_files ${chart_library}/uPlot.esm.js ${chart_library}/uPlot.min.css)
else()
    message(STATUS "The viewer is built without its chart: npm could not fetch uplot")
endif()

set(viewer_source ${made}/viewer_files.cpp)
embed_files(${viewer_source} service/viewer/viewer_files.h viewer_files ${viewer_files})
