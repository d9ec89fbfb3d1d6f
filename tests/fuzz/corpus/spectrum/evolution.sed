Comment:
Version: 2.3 [1.2.3]
Columns [4]:
Data:
Wvl	Rad. (Ref.)	Rad. (Target)	Reflect. %
400	12.5	6.1	5
450	12.5	6.1	6
551	12.5	6.1	12.5
680	12.5	6.1	4.75
800	12.5	6.1	45
1650	12.5	6.1	30.25
