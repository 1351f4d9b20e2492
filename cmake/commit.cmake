# Writes the commit that is built into ${OUT}, when that has changed: "unknown" outside of git, with
# "-changed" behind it when tracked files differ from it.
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-toplevel
    OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(commit unknown)
if(top STREQUAL SOURCE) # no repository that this merely lies in
    execute_process(
        COMMAND git -C ${SOURCE} describe --always --abbrev=12 --exclude=* --dirty=-changed
        OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(described)
        set(commit ${described})
    endif()
endif()
set(text "namespace plumb {\nextern const char *const commit_text;\nconst char *const commit_text = \"${commit}\";\n}\n")
set(before "")
if(EXISTS ${OUT})
    file(READ ${OUT} before)
endif()
if(NOT before STREQUAL text)
    file(WRITE ${OUT} "${text}")
endif()
