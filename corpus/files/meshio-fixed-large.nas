$ Nastran file written by meshio v5.3.5
BEGIN BULK
GRID*   1                                          0.E+0           0.E+0
*                  0.E+0
GRID*   2                                          1.E+0           0.E+0
*                  0.E+0
GRID*   3                                          1.E+0           1.E+0
*                 2.5E-1
GRID*   4                                          0.E+0           1.E+0
*                  0.E+0
GRID*   5                                          1.E-1          -0.E+0
*                  1.E+0
GRID*   6                                          1.E+0           1.E-1
*                 1.5E+0
GRID*   7                                          1.E+0           1.E+0
*                1.75E+0
GRID*   8                                          0.E+0           9.E-1
*       1.33333333333E+0
GRID*   9                                          3.E+0           0.E+0
*                 -5.E-1
GRID*   10                                         2.E+0           1.E+0
*                  1.E-1
GRID*   11                                        2.5E+0           2.E-1
*                 1.1E+0
GRID*   12                                         2.E+0          1.2E+0
*                 2.1E+0
CQUAD4* 1                               1               5               *11     
*11     8               4               
CQUAD4* 2                               1               2               *12     
*12     6               5               
CQUAD4* 3                               4               8               *13     
*13     7               3               
CQUAD4* 4                               1               4               *14     
*14     3               2               
CQUAD4* 5                               5               6               *15     
*15     7               8               
CQUAD4* 6                               2               9               *16     
*16     11              6               
CQUAD4* 7                               3               7               *17     
*17     12              10              
CQUAD4* 8                               10              9               *18     
*18     2               3               
CQUAD4* 9                               6               11              *19     
*19     12              7               
CQUAD4* 10                              9               10              *1a     
*1a     12              11              
CHEXA*  11                              1               2               *1b     
*1b     3               4               5               6               *2b     
*2b     7               8               
CHEXA*  12                              10              3               *1c     
*1c     2               9               12              7               *2c     
*2c     6               11              
ENDDATA
