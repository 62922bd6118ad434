$ Nastran file written by meshio v5.3.5
BEGIN BULK
GRID    1                     0.      0.      0.
GRID    2                     1.      0.      0.
GRID    3                     1.      1.    0.25
GRID    4                     0.      1.      0.
GRID    5                    0.1     -0.      1.
GRID    6                     1.     0.1     1.5
GRID    7                     1.      1.    1.75
GRID    8                     0.     0.91.333333
GRID    9                     3.      0.    -0.5
GRID    10                    2.      1.     0.1
GRID    11                   2.5     0.2     1.1
GRID    12                    2.     1.2     2.1
CQUAD4  1               1       5       8       4       
CQUAD4  2               1       2       6       5       
CQUAD4  3               4       8       7       3       
CQUAD4  4               1       4       3       2       
CQUAD4  5               5       6       7       8       
CQUAD4  6               2       9       11      6       
CQUAD4  7               3       7       12      10      
CQUAD4  8               10      9       2       3       
CQUAD4  9               6       11      12      7       
CQUAD4  10              9       10      12      11      
CHEXA   11              1       2       3       4       5       6       +1b     
+1b     7       8       
CHEXA   12              10      3       2       9       12      7       +1c     
+1c     6       11      
ENDDATA
