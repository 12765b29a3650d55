# cmake -DSOURCE=FOLDER -DOUTPUT=FILE.cpp -P embed_page.cmake: puts inspect.css and inspect.js into inspect.html, with
# their SHA-256 in its content security policy, and writes it as C++ string literals, cut where the data go.
cmake_policy(VERSION 3.25)

# The base64 form of a text's SHA-256.
function(sha256_base64 text result)
  set(digits ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/)
  string(SHA256 hash "${text}")
  string(APPEND hash 00) # 32 bytes are ten groups of three and one of two
  set(base64 "")
  foreach(at RANGE 0 60 6)
    string(SUBSTRING ${hash} ${at} 6 group)
    foreach(shift 18 12 6 0)
      math(EXPR digit "(0x${group} >> ${shift}) & 63")
      string(SUBSTRING ${digits} ${digit} 1 digit)
      string(APPEND base64 ${digit})
    endforeach()
  endforeach()
  string(REGEX REPLACE "A$" "=" base64 ${base64})
  set(${result} ${base64} PARENT_SCOPE)
endfunction()

# A text as neighbouring raw literals that each compiler takes.
function(as_literals text result)
  set(literals "")
  string(LENGTH "${text}" length)
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 piece)
    string(APPEND literals "\n    R\"page(${piece})page\"")
    math(EXPR at "${at} + 8000")
  endwhile()
  set(${result} "${literals}" PARENT_SCOPE)
endfunction()

file(READ ${SOURCE}/inspect.html page)
foreach(kind css js)
  file(READ ${SOURCE}/inspect.${kind} text)
  if(text MATCHES "[^\t\n -~]")
    message(FATAL_ERROR "inspect.${kind} must be ASCII")
  endif()
  sha256_base64("${text}" hash)
  string(REPLACE "@${kind}_hash@" "sha256-${hash}" page "${page}")
  string(REPLACE "@${kind}@" "${text}" page "${page}")
endforeach()
string(FIND "${page}" "@data@" cut)
string(SUBSTRING "${page}" 0 ${cut} before)
math(EXPR cut "${cut} + 6")
string(SUBSTRING "${page}" ${cut} -1 after)
as_literals("${before}" before)
as_literals("${after}" after)
file(WRITE ${OUTPUT} "#include \"reports/inspect_html.h\"

namespace bendy::tools {

const std::string_view kPageBeforeData =${before};
const std::string_view kPageAfterData =${after};

}  // namespace bendy::tools
")
